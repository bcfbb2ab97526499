// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/tiles.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <span>
#include <system_error>

#include "base/error.h"
#include "base/file_extension.h"
#include "base/hash.h"
#include "base/order_statistics.h"
#include "base/other_tiles.h"
#include "base/parallel.h"
#include "io/bytes/json.h"

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

// The 95th percentile of the depths; 0 without observations.
double large_depth(std::vector<double>& depths) {
  return depths.empty() ? 0 : value_at_place(depths, (depths.size() - 1) * 19 / 20);
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
  return kMarginInThresholds * options.depth_threshold * large_depth(depths);
}

constexpr int kTileVersion = 1;

fs::path side_file(const fs::path& ply) {
  return ply.string() + ".json";
}

// A fingerprint of the file's bytes. Empty if it cannot be read.
std::string content_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string bytes(std::size_t{1} << 20, '\0');
  Fingerprint print;
  while (in.read(bytes.data(), static_cast<std::streamsize>(bytes.size())) || in.gcount() > 0)
    print.add(std::string_view(bytes).substr(0, static_cast<std::size_t>(in.gcount())));
  return in.eof() ? print.hex() : std::string();
}

// What the side file says of a cloud that is complete and still has the bytes that were written.
std::optional<nlohmann::json> side_of(const fs::path& ply) {
  std::error_code ignored;
  if (!fs::is_regular_file(ply, ignored) || !fs::is_regular_file(side_file(ply), ignored))
    return {};
  try {
    nlohmann::json side = io::read_json(side_file(ply));
    if (side.at("version") != kTileVersion || side.at("content") != content_of(ply)) return {};
    return side;
  } catch (const Error&) {
    return {};
  } catch (const nlohmann::json::exception&) {  // an entry is missing or has another type
    return {};
  }
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
  const Eigen::Matrix3d rotation =
      project.scene.region ? project.scene.region->rotation : Eigen::Matrix3d::Identity();
  const auto tiles = cloud::make_tiles(positions, options.tiles, rotation);
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

fs::path tile_file(const fs::path& output, std::size_t tile, std::size_t tiles) {
  return fs::path(output).replace_extension(fmt::format(".tile{}-{}.ply", tile, tiles));
}

std::vector<fs::path> files_of_tile(const fs::path& output, std::size_t tile, std::size_t tiles) {
  const fs::path ply = tile_file(output, tile, tiles);
  return {ply, side_file(ply)};
}

void finish_tile(const fs::path& ply, const std::string& made_from, const CloudCounts& counts,
                 const cloud::Tile& tile) {
  io::write_json(side_file(ply), {{"version", kTileVersion},
                                  {"made_from", made_from},
                                  {"content", content_of(ply)},
                                  {"points", counts.points},
                                  {"of_two_maps", counts.of_two},
                                  {"removed", counts.removed},
                                  {"rotation", numbers(tile.rotation.transpose().reshaped())},
                                  {"low", numbers(tile.low)},
                                  {"high", numbers(tile.high)}});
}

std::optional<CloudCounts> finished_tile(const fs::path& ply, const std::string& made_from) {
  const std::optional<nlohmann::json> side = side_of(ply);
  try {
    if (!side || side->at("made_from") != made_from) return {};
    return CloudCounts{side->at("points"), side->at("of_two_maps"), side->at("removed")};
  } catch (const nlohmann::json::exception&) {  // an entry is missing or has another type
    return {};
  }
}

void remove_tile(const fs::path& ply) {
  std::error_code ignored;
  fs::remove(ply, ignored);
  fs::remove(side_file(ply), ignored);
}

void remove_tiles(const fs::path& output, std::size_t tiles) {
  for (std::size_t tile = 1; tile <= tiles; ++tile) remove_tile(tile_file(output, tile, tiles));
  std::vector<fs::path> foreign;
  for (const fs::path& file : other_tiles(output, tiles)) {
    if (lower_extension(file) != ".ply") continue;
    if (side_of(file))
      remove_tile(file);
    else
      foreign.push_back(file);
  }
  warn_of_other_tiles(foreign);
}

}  // namespace axial::densify
