// SPDX-License-Identifier: GPL-3.0-or-later
// The tiles in which a cloud is fused. They follow from the sparse cloud alone, so that runs on
// several machines divide the scene in the same way.
#pragma once

#include <cstddef>
#include <vector>

#include "cloud/fuse.h"
#include "densify/project.h"

namespace axial::densify {

// Returns Settings::fusion_tiles parts with about equal numbers of sparse points
// (cloud::make_tiles). The points are those that at least one reference sees; if the cloud is
// cropped to the region of interest, those inside it. The tiles have the axes of the region, or of
// the world without a region. FusionPart::seen_by is empty.
//
// A tile's reach is the tile and a margin of kMarginInThresholds times the difference of depth that
// still agrees: FuseOptions::depth_threshold times the 95th percentile of the depths at which
// images observe the points of the tile. The reason: two points compete for a pixel only if they
// are within two such differences of each other, and each link of a chain of such points reaches as
// far. The factor was measured (docs/formats.md).
std::vector<cloud::FusionPart> tiles_of(const Project& project, const Settings& settings);

inline constexpr double kMarginInThresholds = 8;

// Estimates cloud::views_needed() of the tile that needs the most views. A view counts as seeing a
// tile if it sees a sparse point in the tile's reach.
std::size_t most_views_of_a_tile(const Project& project, const Settings& settings);

}  // namespace axial::densify
