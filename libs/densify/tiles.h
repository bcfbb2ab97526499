// SPDX-License-Identifier: GPL-3.0-or-later
// The tiles in which a cloud is fused, and their files. The tiles follow from the sparse cloud
// alone, so that runs on several machines divide the scene in the same way. The cloud of a tile
// (.ply) has a side file (.json), which says from what the tile was made.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cloud/fuse.h"
#include "densify/project.h"

namespace axial::densify {

// The views of Project::references, in the same order.
std::vector<cloud::FusionView> views_to_fuse(const Project& project);

// Returns FusionOptions::tiles parts with about equal numbers of sparse points
// (cloud::make_tiles). The points are those that at least one reference sees; if the cloud is
// cropped to the region of interest, those inside it. The tiles have the axes of the region, or of
// the world without a region. FusionPart::seen_by is empty.
//
// A tile's reach is the tile and a margin of kMarginInThresholds times the difference of depth that
// still agrees: FuseOptions::depth_threshold times the 95th percentile of the depths at which
// images observe the points of the tile. The reason: two points compete for a pixel only if they
// are within two such differences of each other, and each link of a chain of such points reaches as
// far. The factor was measured (docs/formats.md).
std::vector<cloud::FusionPart> tiles_of(const Project& project, const FusionOptions& options);

inline constexpr double kMarginInThresholds = 8;

// Estimates cloud::views_needed() of the tile that needs the most views. A view counts as seeing a
// tile if it sees a sparse point in the tile's reach.
std::size_t most_views_of_a_tile(const Project& project, const FusionOptions& options);

// Numbers of points.
struct CloudCounts {
  std::size_t points = 0;   // in the cloud
  std::size_t of_two = 0;   // of these: points that are supported by only two depth maps
  std::size_t removed = 0;  // points that are left out because they are outside the region

  void add(const CloudCounts& more) {
    points += more.points;
    of_two += more.of_two;
    removed += more.removed;
  }
};

// The file of tile `tile` (from 1) of `tiles` tiles of the cloud of the scene `output`:
// <output>.tileI-N.ply. Its side file has ".json" added to the name.
std::filesystem::path tile_file(const std::filesystem::path& output, std::size_t tile,
                                std::size_t tiles);

// The cloud of a tile and its side file.
std::vector<std::filesystem::path> files_of_tile(const std::filesystem::path& output,
                                                 std::size_t tile, std::size_t tiles);

// Writes the side file of the cloud `ply`, which is complete. `made_from`: a text that identifies
// the tile's inputs and settings. The side file also tells the box of the tile, for people and
// tests: rotation (row by row), low and high, with null for a side at infinity.
void finish_tile(const std::filesystem::path& ply, const std::string& made_from,
                 const CloudCounts& counts, const cloud::Tile& tile);

// The numbers of points of a tile. Empty if the cloud or its side file is missing or damaged, or if
// the tile was made from something else.
std::optional<CloudCounts> finished_tile(const std::filesystem::path& ply,
                                         const std::string& made_from);

// Removes the cloud and its side file.
void remove_tile(const std::filesystem::path& ply);

// Removes the tiles of the scene `output`, whose cloud is complete: its `tiles` tiles, and those of
// other numbers of tiles whose side file tells that this program wrote them and that nobody changed
// them. Warns of other clouds with the name of a tile.
void remove_tiles(const std::filesystem::path& output, std::size_t tiles);

}  // namespace axial::densify
