// SPDX-License-Identifier: GPL-3.0-or-later
// Calls a stage of each component that works on meshes, with an octahedron that no photograph
// shows.
#include <axial/compare.h>
#include <axial/map.h>
#include <axial/mesh.h>
#include <axial/refine.h>
#include <axial/texture.h>

#include <cstdio>

namespace {

axial::Mesh octahedron() {
  axial::Mesh mesh;
  mesh.vertices = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (unsigned k = 0; k < 4; ++k) {
    mesh.faces.push_back({k, (k + 1) % 4, 4});
    mesh.faces.push_back({(k + 1) % 4, k, 5});
  }
  return mesh;
}

template <class Stage>
void print_refusal(const char* name, const Stage& stage) {
  try {
    stage();
    std::printf("%s\n", name);
  } catch (const axial::Error& error) {
    std::printf("%s: %s\n", name, error.what());
  }
}

}  // namespace

int main() {
  axial::Mesh mesh = octahedron();
  axial::mesh::CleanOptions small;
  small.spurious = small.cut_off = 0;
  std::printf("mesh: %zu faces\n", axial::mesh::clean(mesh, small).faces.size());
  const auto frame = axial::map::frame_with_up({0, 0, 1}, {});
  std::printf("map: %d columns\n", axial::map::grid_around(mesh, frame, 0.1).columns);
  axial::compare::CompareOptions options;
  options.pixel = 0.05;
  const auto same = axial::compare::compare_surveys(mesh, mesh, frame, options);
  std::printf("compare: %zu changes\n", same.changes.regions.size());
  print_refusal("refine", [&] { axial::refine::refine(mesh, {}, {}); });
  print_refusal("texture", [&] { axial::texture::texture_mesh(mesh, {}, {}); });
}
