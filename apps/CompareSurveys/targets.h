// SPDX-License-Identifier: GPL-3.0-or-later
// The registration by targets that both surveys show: --align targets.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "axial/geometry.h"
#include "compare/target_registration.h"
#include "scene/mesh.h"
#include "settings.h"

namespace axial::apps {

struct ByTargets {
  compare::TargetRegistration found;
  std::vector<std::string> labels;  // of the common targets, as in the earlier survey
};

// Finds the motion of the later survey. Files that `settings` does not state are those in the
// folders of the meshes, and are set. Empty if `settings` asks for no targets, or lets the program
// choose and fewer than three targets are in both surveys. Error for files that are missing or
// wrong, and for targets that do not determine the motion.
std::optional<ByTargets> register_by_targets(Settings& settings);

// Moves the mesh, the photographs and the facing of the later survey from `later`, the frame of
// their coordinates, to `earlier`, the frame of the earlier survey.
void move_later(const ByTargets& by_targets, const LocalFrame& later, const LocalFrame& earlier,
                Mesh& mesh, std::vector<geometry::PosedCamera>& photos, Eigen::Vector3d& facing);

// Logs how well the targets agree, and warns of targets that moved and of different scales.
void report(const ByTargets& by_targets);

}  // namespace axial::apps
