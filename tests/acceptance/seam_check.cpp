// SPDX-License-Identifier: GPL-3.0-or-later
// Looks for seams in a cloud that was fused tile by tile, beside the same cloud in one piece.
// Usage:
//
//     seam_check WHOLE.ply TILED.ply MESH.ply WIDTH TILE.json...
//
// MESH is the true surface, and each TILE.json the side file of a tile. The points of both clouds
// nearer than 30 WIDTH to a border between tiles are counted by their distance to it, in strips of
// WIDTH [m] on each side. Prints one line of JSON: "strips", a list of [points of WHOLE, points of
// TILED, mean distance of WHOLE to the surface [m], of TILED]. The first strip is the one at the
// border.
#include <cmath>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "check_program.h"
#include "cloud/tiles.h"
#include "geometry/surface.h"
#include "io/bytes/json.h"
#include "io/ply/ply.h"

namespace {

using namespace axial;

constexpr std::size_t kStrips = 30;

Eigen::Vector3d side(const nlohmann::json& values, double infinite) {
  Eigen::Vector3d result;
  for (std::size_t i = 0; i < 3; ++i)
    result[static_cast<int>(i)] = values[i].is_null() ? infinite : values[i].get<double>();
  return result;
}

cloud::Tile read_tile(const std::string& file) {
  const nlohmann::json json = io::read_json(file);
  cloud::Tile tile;
  for (int i = 0; i < 9; ++i)
    tile.rotation(i / 3, i % 3) = json["rotation"][static_cast<std::size_t>(i)].get<double>();
  tile.low = side(json["low"], -cloud::Tile::kInfinity);
  tile.high = side(json["high"], cloud::Tile::kInfinity);
  return tile;
}

// The distance from a point to the nearest border of the tile that contains it.
double distance_to_border(const std::vector<cloud::Tile>& tiles, const Eigen::Vector3d& point) {
  for (const cloud::Tile& tile : tiles) {
    if (!tile.contains(point)) continue;
    const Eigen::Vector3d along = tile.rotation * point;
    return std::min((along - tile.low).minCoeff(), (tile.high - along).minCoeff());
  }
  fail("a point lies in no tile");
}

struct Strip {
  std::size_t points = 0;
  double sum = 0;
};

std::vector<Strip> strips_of(const std::string& file, const std::vector<cloud::Tile>& tiles,
                             const geometry::Surface& surface, double width) {
  std::vector<Eigen::Vector3f> near;
  std::vector<std::size_t> strip_of;
  for (const Eigen::Vector3f& point : io::read_cloud_ply(file).positions) {
    const double distance = distance_to_border(tiles, point.cast<double>()) / width;
    if (distance >= static_cast<double>(kStrips)) continue;
    near.push_back(point);
    strip_of.push_back(static_cast<std::size_t>(distance));
  }
  const std::vector<float> errors = geometry::distances_to(surface, near);
  std::vector<Strip> strips(kStrips);
  for (std::size_t i = 0; i < near.size(); ++i) {
    ++strips[strip_of[i]].points;
    strips[strip_of[i]].sum += static_cast<double>(errors[i]);
  }
  return strips;
}

int run(int argc, char** argv) {
  std::vector<cloud::Tile> tiles;
  for (int i = 5; i < argc; ++i) tiles.push_back(read_tile(argv[i]));
  const geometry::Surface surface(io::read_mesh_ply(argv[3]));
  const double width = std::stod(argv[4]);
  const std::vector<Strip> whole = strips_of(argv[1], tiles, surface, width);
  const std::vector<Strip> tiled = strips_of(argv[2], tiles, surface, width);
  nlohmann::json strips;
  for (std::size_t i = 0; i < kStrips; ++i) {
    const auto mean = [](const Strip& strip) {
      return strip.sum / static_cast<double>(std::max<std::size_t>(strip.points, 1));
    };
    strips.push_back({whole[i].points, tiled[i].points, mean(whole[i]), mean(tiled[i])});
  }
  std::cout << io::to_text(nlohmann::json{{"strips", strips}}) << "\n";
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return axial::check_program(argc, argv, 5, 999,
                              "seam_check WHOLE.ply TILED.ply MESH.ply WIDTH TILE.json...", run);
}
