// SPDX-License-Identifier: GPL-3.0-or-later
// Whether lengths and positions that are known in metres have a hold on a bundle.
#pragma once

#include <string>
#include <vector>

#include "pose/adjust.h"

namespace axial::pose {

// Why what `options` say is known in metres does not tell the bundle's scale, one line each; empty
// where it does. A distance does not if an end has no observations, or if no chain of points leads
// from one end to the other. Positions do not if fewer than three are of images with observations,
// or those lie on one line.
std::vector<std::string> lost_knowledge(const Bundle& bundle, const AdjustOptions& options);

// The indices into `options.positions` of those whose images have no observations.
std::vector<std::size_t> lost_positions(const Bundle& bundle, const AdjustOptions& options);

}  // namespace axial::pose
