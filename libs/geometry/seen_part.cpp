// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/seen_part.h"

#include <algorithm>

#include "geometry/faces.h"
#include "geometry/surface.h"

namespace axial::geometry {
namespace {

// At most `most` of the numbers from 0 to `count` - 1, at equal distances.
std::vector<std::uint32_t> spread_indices(std::size_t count, std::size_t most) {
  const std::size_t chosen = std::min(count, most);
  std::vector<std::uint32_t> indices;
  indices.reserve(chosen);
  for (std::size_t i = 0; i < chosen; ++i)
    indices.push_back(static_cast<std::uint32_t>(i * count / chosen));
  return indices;
}

// The bounding box of the seen faces of the sample, grown on all sides by half of its longest side.
// Fills the other members of `part` but `strays`.
Eigen::AlignedBox3f look_at_sample(const Mesh& mesh, std::span<const std::uint32_t> sample,
                                   const FaceSights& sights, SeenPart& part) {
  Eigen::AlignedBox3f box;
  double area = 0;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    if (sights.front[i] == 0 && sights.back[i] == 0) continue;
    const bool from_front = sights.front[i] > sights.back[i];
    ++(from_front ? part.front : part.back);
    const Eigen::Vector3d normal = area_vector(mesh, sample[i]);
    part.facing += from_front ? normal : Eigen::Vector3d(-normal);
    area += normal.norm();
    for (const std::uint32_t corner : mesh.faces[sample[i]]) box.extend(mesh.vertices[corner]);
  }
  if (area > 0) part.facing /= area;
  if (box.isEmpty()) return box;
  const float margin = 0.5f * box.sizes().maxCoeff();
  box.min().array() -= margin;
  box.max().array() += margin;
  return box;
}

std::vector<std::uint32_t> faces_outside(const Mesh& mesh, const Eigen::AlignedBox3f& box) {
  std::vector<std::uint32_t> outside;
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
    if (std::ranges::none_of(mesh.faces[f], [&](std::uint32_t corner) {
          return box.contains(mesh.vertices[corner]);
        }))
      outside.push_back(f);
  return outside;
}

}  // namespace

SeenPart find_seen_part(const Mesh& mesh, std::span<const PosedCamera> cameras,
                        const SeenPartOptions& options) {
  const Surface surface(mesh);
  std::vector<PosedCamera> some;
  for (const std::uint32_t camera : spread_indices(cameras.size(), options.cameras))
    some.push_back(cameras[camera]);
  const std::vector<std::uint32_t> sample = spread_indices(mesh.faces.size(), options.faces);
  SeenPart part;
  const Eigen::AlignedBox3f near =
      look_at_sample(mesh, sample, count_sights(mesh, surface, sample, some), part);
  if (!options.strays || near.isEmpty()) return part;
  const std::vector<std::uint32_t> outside = faces_outside(mesh, near);
  if (outside.empty()) return part;
  const FaceSights sights = count_sights(mesh, surface, outside, cameras);
  for (std::size_t i = 0; i < outside.size(); ++i)
    if (sights.front[i] == 0 && sights.back[i] == 0) part.strays.push_back(outside[i]);
  return part;
}

void warn_of_strays(const SeenPart& part, const std::filesystem::path& mesh, std::size_t faces,
                    const Context& context) {
  if (part.strays.empty()) return;
  context.warning(
      "{}: {} of {} faces are left out: no camera sees them, and they are far from everything that "
      "the cameras see",
      mesh.string(), part.strays.size(), faces);
}

void warn_if_inside_out(const SeenPart& part, const std::filesystem::path& mesh,
                        const Context& context) {
  if (!part.is_inside_out()) return;
  context.warning(
      "{}: the mesh is inside out: the cameras see {:.0f} % of its faces from behind; flip the "
      "faces in an editor (MeshLab: Invert Faces Orientation; Blender: Flip Normals)",
      mesh.string(),
      100.0 * static_cast<double>(part.back) / static_cast<double>(part.front + part.back));
}

}  // namespace axial::geometry
