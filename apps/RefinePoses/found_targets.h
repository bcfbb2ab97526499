// SPDX-License-Identifier: GPL-3.0-or-later
// --targets find: targets in the photographs of the model.
#pragma once

#include "stages.h"

namespace axial::apps {

// Finds targets in the photographs of the model, writes them to targets.json in the output folder,
// and reads bars and control points: sets Input::control. Error that names a photograph that is not
// in the folder of --images, and if no photograph shows a target.
void find_targets(const Options& options, Input& input, const Context& context);

}  // namespace axial::apps
