// SPDX-License-Identifier: GPL-3.0-or-later
// Targets at the corners of a boundary.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace axial::boundary {

// The places [world, m] of the targets `labels`, in their order, as read from `file`:
// target_places.json of RefinePoses, or a file of control points (control/read_control.h), whose
// coordinates must be those of the world. Error that names the file for a label that it does not
// have, for two labels of one target, and for a target that has no known place; Errors of the
// readers are passed on.
std::vector<Eigen::Vector3d> places_of_targets(const std::filesystem::path& file,
                                               std::span<const std::string> labels);

}  // namespace axial::boundary
