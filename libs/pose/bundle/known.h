// SPDX-License-Identifier: GPL-3.0-or-later
// Checks whether lengths and positions that are known in metres determine the scale of a bundle.
#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "pose/bundle/adjust_options.h"

namespace axial::pose {

// Returns one line for each reason why `options.distances` or `options.positions` cannot be used to
// determine the scale of the bundle: first the lines of the distances, in their order, then at most
// one line of the positions. Empty if there is no reason. A distance cannot be used if one of its
// ends has no observations or is not in the bundle, or if no chain of common points connects its
// ends. Bars (KnownDistance::name) are not looked at. The position of an image without observations
// is lost. If positions are lost, the remaining positions cannot be used if they are fewer than
// three or lie on one line.
std::vector<std::string> lost_knowledge(const Bundle& bundle, const AdjustOptions& options);

// The present place [m] of an image or of a point. `index`: as KnownDistance::first. Error as for
// point_of().
Eigen::Vector3d place_in(const Bundle& bundle, KnownDistance::Between of, std::size_t index);

// The indices into `options.positions` of the lost positions, in ascending order. A position is
// lost if its image has no observations.
std::vector<std::size_t> lost_positions(const Bundle& bundle, const AdjustOptions& options);

// The camera centres of the images whose positions are known, and these positions, as columns.
std::pair<Eigen::Matrix3Xd, Eigen::Matrix3Xd> centres_and_positions(
    const Bundle& bundle, const std::vector<KnownPosition>& positions);

}  // namespace axial::pose
