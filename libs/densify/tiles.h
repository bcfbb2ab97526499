// SPDX-License-Identifier: GPL-3.0-or-later
// The tiles in which a cloud is fused, and their files. The tiles follow from the sparse cloud
// alone, so that runs on several machines divide the scene in the same way. The cloud of a tile is
// the file tile_file() of base/program/tiling.h, with a mark in its side file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cloud/fuse.h"
#include "densify/project.h"
#include "io/artifacts/artifact.h"

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

// Writes the mark (io/artifacts/artifact.h) of the cloud of a tile, which is complete. The mark
// also tells the box of the tile, for people and tests: rotation (row by row), low and high, with
// null for a side at infinity.
void finish_tile(const io::Artifact& cloud, const CloudCounts& counts, const cloud::Tile& tile);

// The numbers of points of a tile. Empty if the cloud or its mark is missing or damaged, or if the
// tile was made from something else.
std::optional<CloudCounts> finished_tile(const io::Artifact& cloud);

// Removes the tiles of the scene `output`, whose cloud is complete: its `tiles` tiles, and those of
// other numbers of tiles whose mark tells that this program wrote them and that nobody changed
// them. Warns of other clouds with the name of a tile.
void remove_tiles(const std::filesystem::path& output, std::size_t tiles, const Context& context);

}  // namespace axial::densify
