// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/tiles.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>

#include "base/file_extension.h"
#include "base/parallel.h"
#include "base/program/tiling.h"

namespace axial::densify {
namespace fs = std::filesystem;

namespace {

std::vector<bool> are_references(const Project& project) {
  std::vector<bool> are(project.scene.images.size(), false);
  for (const std::size_t image : project.references) are[image] = true;
  return are;
}

// The sparse points that decide on the tiles.
std::vector<const SparsePoint*> points_to_divide(const Project& project,
                                                 const FusionOptions& options) {
  const Scene& scene = project.scene;
  const std::vector<bool> references = are_references(project);
  std::vector<const SparsePoint*> points;
  for (const SparsePoint& point : scene.points) {
    const bool seen = std::ranges::any_of(
        point.views, [&](const SparseView& view) { return references[view.image]; });
    const bool cropped = options.crop_to_roi && scene.region &&
                         !scene.region->contains(point.position.cast<double>());
    if (seen && !cropped && point.position.allFinite()) points.push_back(&point);
  }
  return points;
}

double margin_of(const cloud::Tile& tile, const Project& project,
                 std::span<const SparsePoint* const> points, const FusionOptions& options) {
  std::vector<double> depths;
  for (const SparsePoint* point : points) {
    const Eigen::Vector3d place = point->position.cast<double>();
    if (!tile.contains(place)) continue;
    for (const SparseView& view : point->views)
      if (project.scene.images[view.image].calibrated)
        depths.push_back((project.scene.images[view.image].pose.centre - place).norm());
  }
  return cloud::tile_margin(kMarginInThresholds * options.depth_threshold, depths);
}

std::vector<double> numbers(const Eigen::VectorXd& values) {
  return {values.begin(), values.end()};
}

}  // namespace

std::vector<cloud::FusionView> views_to_fuse(const Project& project) {
  std::vector<cloud::FusionView> views;
  for (const std::size_t image : project.references) {
    cloud::FusionView view{static_cast<std::uint32_t>(image), {}, 0};
    for (const ViewScore& neighbour : project.neighbours[image])
      view.neighbours.push_back(neighbour.image);
    view.rank = project.scene.images[image].neighbours.size();
    views.push_back(view);
  }
  return views;
}

std::vector<cloud::FusionPart> tiles_of(const Project& project, const FusionOptions& options) {
  const auto points = points_to_divide(project, options);
  std::vector<Eigen::Vector3f> positions;
  for (const SparsePoint* point : points) positions.push_back(point->position);
  const auto tiles = cloud::make_tiles(positions, options.tiles, cloud::tile_axes(project.scene));
  std::vector<cloud::FusionPart> parts(tiles.size());
  parallel_for(tiles.size(), [&](std::size_t i) {
    const double margin = margin_of(tiles[i], project, points, options);
    parts[i] = {tiles[i], cloud::grown(tiles[i], margin), {}};
  });
  return parts;
}

std::size_t most_views_of_a_tile(const Project& project, const FusionOptions& options) {
  const std::vector<cloud::FusionView> views = views_to_fuse(project);
  std::vector<cloud::FusionPart> parts = tiles_of(project, options);
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

void finish_tile(const io::Artifact& cloud, const CloudCounts& counts, const cloud::Tile& tile) {
  io::write_mark(cloud, {{"points", counts.points},
                         {"of_two_maps", counts.of_two},
                         {"removed", counts.removed},
                         {"rotation", numbers(tile.rotation.transpose().reshaped())},
                         {"low", numbers(tile.low)},
                         {"high", numbers(tile.high)}});
}

std::optional<CloudCounts> finished_tile(const io::Artifact& cloud) {
  const std::optional<nlohmann::json> mark = io::read_mark(cloud);
  try {
    if (mark) return CloudCounts{mark->at("points"), mark->at("of_two_maps"), mark->at("removed")};
  } catch (const nlohmann::json::exception&) {
    // An entry is missing or has another type.
  }
  return {};
}

void remove_tiles(const fs::path& output, std::size_t tiles, const Context& context) {
  for (std::size_t tile = 1; tile <= tiles; ++tile)
    io::remove_with_side_file(tile_file(output, tile, tiles, ".ply"));
  std::vector<fs::path> foreign;
  for (const fs::path& file : other_tiles(output, tiles)) {
    if (lower_extension(file) != ".ply") continue;
    if (io::read_mark(file))
      io::remove_with_side_file(file);
    else
      foreign.push_back(file);
  }
  warn_of_other_tiles(foreign, context);
}

}  // namespace axial::densify
