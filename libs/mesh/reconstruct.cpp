// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/reconstruct.h"

#include <algorithm>

#include "base/error.h"
#include "base/memory.h"
#include "cloud/crop.h"
#include "mesh/cast_votes.h"
#include "mesh/cut.h"
#include "mesh/surface.h"
#include "mesh/tetrahedra.h"
#include "mesh/view_rays.h"

namespace axial::mesh {
namespace {

// The largest number of merged points, at least 1, whose mesh needs at most `max_bytes`.
std::size_t most_points(std::uint64_t max_bytes) {
  const std::uint64_t fixed = bytes_needed(0), each = bytes_needed(1) - fixed;
  return std::max<std::size_t>(max_bytes > fixed ? (max_bytes - fixed) / each : 0, 1);
}

MergedPoints merged(PointCloud cloud, const Scene& scene, const ViewRays& rays,
                    const ReconstructOptions& options, const Context& context) {
  const std::size_t all = cloud.size();
  if (options.only_region && scene.region) cloud::crop(cloud, *scene.region);
  MergeOptions settings = options.merge;
  if (context.memory().is_limited()) settings.most_points = most_points(context.memory().limit());
  MergedPoints points = merge_points(cloud, rays, settings);
  context.info("{} points merged to {}", all, points.count);
  if (points.count < 4) fail("{} points remain of {}: at least 4 are needed", points.count, all);
  return points;
}

void check_memory(std::size_t points, const MemoryBudget& memory) {
  const std::uint64_t needed = bytes_needed(points);
  if (memory.is_limited() && needed > memory.limit())
    fail(
        "{} merged points need about {} MB, but {} is {}; a larger {} merges more points, and a "
        "larger {} needs less memory",
        points, needed / kMegabyte, setting("max_memory"), memory.limit() / kMegabyte,
        setting("merge.min_distance"), setting("tiles"));
}

Surface cut_surface(const MergedPoints& points, const ViewRays& rays,
                    const ReconstructOptions& options, const Context& context) {
  const Tetrahedra tetrahedra = delaunay(points.positions);
  return_freed_memory();
  context.info("{} tetrahedra", tetrahedra.size());
  Votes votes = cast_votes(tetrahedra, points, rays, options.votes, context);
  const std::vector<bool> inside = occupied(tetrahedra, votes);
  votes = {};
  Surface surface = surface_without_long_edges(tetrahedra, points.positions, points.pixel_widths,
                                               inside, options.clean.spurious);
  context.info("Surface: {} vertices, {} faces", surface.mesh.vertices.size(),
               surface.mesh.faces.size());
  return surface;
}

// Removes the faces with a corner outside of the region.
void crop(Mesh& mesh, const OrientedBox& region) {
  std::vector<bool> kept;
  kept.reserve(mesh.vertices.size());
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    kept.push_back(region.contains(vertex.cast<double>()));
  std::erase_if(mesh.faces, [&](const auto& face) {
    return std::ranges::any_of(face, [&](std::uint32_t corner) { return !kept[corner]; });
  });
}

}  // namespace

std::uint64_t bytes_needed(std::size_t merged_points) {
  // Measured: a point has 6.8 tetrahedra; each has 32 bytes of its own and 24 of votes, and in the
  // cut 48 bytes for itself and two edges of 64.
  return 60'000'000 + merged_points * 1700;
}

void check_points(const PointCloud& cloud, const Scene& scene, std::size_t first) {
  if (cloud.view_begin.empty())
    fail("the points have no views, which tell the free space in front of them");
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.positions[i].allFinite()) fail("the position of point {} is not finite", first + i);
    for (const std::uint32_t view : cloud.views_of(i)) {
      if (view >= scene.images.size())
        fail("point {} names view {}, but the scene has {} images", first + i, view,
             scene.images.size());
      if (!scene.images[view].calibrated)
        fail("point {} names view {}, an image without calibration: {}", first + i, view,
             scene.images[view].path);
    }
  }
  constexpr float kLargestWeight = 1e6f;  // sums of weights stay far from the largest float
  for (const float weight : cloud.view_weights)
    if (!(weight >= 0 && weight <= kLargestWeight))
      fail("a view of a point has the weight {}, which must be from 0 to {}", weight,
           kLargestWeight);
}

Mesh reconstruct_merged(MergedPoints points, const Scene& scene, const ViewRays& rays,
                        const ReconstructOptions& options, const Context& context) {
  if (points.size() < 4) return {};
  check_memory(points.size(), context.memory());
  Surface surface = cut_surface(points, rays, options, context);
  points = {};
  return_freed_memory();
  if (options.crop_to_region && scene.region) crop(surface.mesh, *scene.region);
  if (surface.mesh.faces.empty()) return {};
  CleanReport report;
  Mesh mesh = clean(surface.mesh, options.clean, &report);
  context.info(
      "Cleaned: {} spurious pieces and {} spikes removed, {} holes closed, {} faces removed "
      "that intersected others",
      report.removed_components, report.removed_spikes, report.closed_holes,
      report.removed_intersections);
  return mesh;
}

Mesh reconstruct(PointCloud cloud, const Scene& scene, const ReconstructOptions& options,
                 const Context& context) {
  if (cloud.positions.empty()) fail("the cloud has no points");
  check_points(cloud, scene);
  const ViewRays rays(scene);
  MergedPoints points = merged(std::move(cloud), scene, rays, options, context);
  return_freed_memory();
  check_memory(points.count, context.memory());
  ReconstructOptions settings = options;
  settings.clean.may_be_empty = false;
  Mesh mesh = reconstruct_merged(std::move(points), scene, rays, settings, context);
  if (mesh.faces.empty()) fail("no surface separates free space from points");
  return mesh;
}

}  // namespace axial::mesh
