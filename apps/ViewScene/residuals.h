// SPDX-License-Identifier: GPL-3.0-or-later
// The residuals of a scene as the page shows them.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "base/context.h"
#include "io/openmvs/scene_with_cameras.h"

namespace axial::apps {

// The part "residuals" of data/scene.js, for the observations of the COLMAP model in `folder`:
// - observations, unseen (without image), rms and, with the poses freed, rms_freed [px].
// - cameras: for each pair of lens and port: its numbers of photographs, errors, the judgement of
//   diagnosis::ResidualPattern, and its grid. Errors of the grid have the pose of each photograph
//   freed.
// - photographs: for each its number in "cameras" of the scene, errors, and its grid. Errors are
//   those with the poses of the scene.
// - causes: diagnosis::residual_causes(), if a camera shows a pattern.
// A cell of a grid is a list: count, mean x, mean y, standard error, RMS [px].
// Errors as for read_tracks().
nlohmann::ordered_json residual_data(const io::SceneWithCameras& scene,
                                     const std::filesystem::path& folder, const Context& context);

}  // namespace axial::apps
