// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/fusion_tiles.h"

#include <algorithm>
#include <span>

#include "base/order_statistics.h"
#include "base/parallel.h"
#include "densify/fusion_run.h"

namespace axial::densify {
namespace {

std::vector<bool> are_references(const Project& project) {
  std::vector<bool> are(project.scene.images.size(), false);
  for (const std::size_t image : project.references) are[image] = true;
  return are;
}

// The sparse points that decide on the tiles.
std::vector<const SparsePoint*> points_to_divide(const Project& project, const Settings& settings) {
  const Scene& scene = project.scene;
  const std::vector<bool> references = are_references(project);
  std::vector<const SparsePoint*> points;
  for (const SparsePoint& point : scene.points) {
    const bool seen = std::ranges::any_of(
        point.views, [&](const SparseView& view) { return references[view.image]; });
    const bool cropped = settings.crop_to_roi && scene.region &&
                         !scene.region->contains(point.position.cast<double>());
    if (seen && !cropped && point.position.allFinite()) points.push_back(&point);
  }
  return points;
}

// The 95th percentile of the depths; 0 without observations.
double large_depth(std::vector<double>& depths) {
  return depths.empty() ? 0 : value_at_place(depths, (depths.size() - 1) * 19 / 20);
}

double margin_of(const cloud::Tile& tile, const Project& project,
                 std::span<const SparsePoint* const> points, const Settings& settings) {
  std::vector<double> depths;
  for (const SparsePoint* point : points) {
    const Eigen::Vector3d place = point->position.cast<double>();
    if (!tile.contains(place)) continue;
    for (const SparseView& view : point->views)
      if (project.scene.images[view.image].calibrated)
        depths.push_back((project.scene.images[view.image].pose.centre - place).norm());
  }
  return kMarginInThresholds * settings.fusion.depth_threshold * large_depth(depths);
}

}  // namespace

std::vector<cloud::FusionPart> tiles_of(const Project& project, const Settings& settings) {
  const auto points = points_to_divide(project, settings);
  std::vector<Eigen::Vector3f> positions;
  for (const SparsePoint* point : points) positions.push_back(point->position);
  const Eigen::Matrix3d rotation =
      project.scene.region ? project.scene.region->rotation : Eigen::Matrix3d::Identity();
  const auto tiles = cloud::make_tiles(positions, settings.fusion_tiles, rotation);
  std::vector<cloud::FusionPart> parts(tiles.size());
  parallel_for(tiles.size(), [&](std::size_t i) {
    const double margin = margin_of(tiles[i], project, points, settings);
    parts[i] = {tiles[i], cloud::grown(tiles[i], margin), {}};
  });
  return parts;
}

std::size_t most_views_of_a_tile(const Project& project, const Settings& settings) {
  const std::vector<cloud::FusionView> views = views_to_fuse(project);
  std::vector<cloud::FusionPart> parts = tiles_of(project, settings);
  std::vector<std::size_t> needed(parts.size());
  parallel_for(parts.size(), [&](std::size_t i) {
    cloud::FusionPart& part = parts[i];
    std::vector<bool> sees(project.scene.images.size(), false);
    for (const SparsePoint& point : project.scene.points)
      if (part.reach.contains(point.position.cast<double>()))
        for (const SparseView& view : point.views) sees[view.image] = true;
    for (const cloud::FusionView& view : views) part.seen_by.push_back(sees[view.image]);
    needed[i] = cloud::views_needed(views, part);
  });
  return *std::ranges::max_element(needed);
}

}  // namespace axial::densify
