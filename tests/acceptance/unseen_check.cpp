// SPDX-License-Identifier: GPL-3.0-or-later
// Measures how much of a mesh the cameras cannot see, because it is turned away from them or hidden
// by the mesh itself. Usage:
//
//     unseen_check MESH.ply MODEL [HOUSING.json]
//
// MODEL is a COLMAP model in the frame of the mesh. Samples of the mesh, uniform by area, are
// lifted a little from the front of their faces. So a face that is turned away from a camera hides
// its own samples. Prints one line of JSON: "no_view" and "one_view", the shares of samples that no
// camera and exactly one camera sees.
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/error.h"
#include "check_program.h"
#include "evaluate/views.h"
#include "geometry/sampling.h"
#include "geometry/surface.h"
#include "io/bytes/json.h"
#include "io/ply/ply.h"

namespace {

using namespace axial;

int run(int argc, char** argv) {
  const Mesh mesh = io::read_mesh_ply(argv[1]);
  const io::ColmapModel model = io::read_colmap_model(argv[2]);
  std::optional<io::Housing> housing;
  if (argc == 4) housing = io::read_housing(argv[3]);
  const auto views = evaluate::views_of_model(model, housing ? &*housing : nullptr);
  const geometry::Surface surface(mesh);
  std::vector<std::uint32_t> faces;
  std::vector<Eigen::Vector3f> samples = geometry::sample_surface(mesh, 300'000, 1, &faces);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    // More than the part of a segment next to its begin that cannot be blocked.
    const double lift = 5e-4 * (views[0].pose.centre - samples[i].cast<double>()).norm();
    samples[i] += (lift * surface.face_normal(faces[i])).cast<float>();
  }
  double none = 0, one = 0;
  for (const std::uint32_t count : evaluate::count_views(samples, views, surface)) {
    none += count == 0;
    one += count == 1;
  }
  const auto all = static_cast<double>(samples.size());
  std::cout << io::to_text(nlohmann::json{{"no_view", none / all}, {"one_view", one / all}})
            << "\n";
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return axial::check_program(argc, argv, 2, 3, "unseen_check MESH.ply MODEL [HOUSING.json]", run);
}
