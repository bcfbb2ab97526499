// SPDX-License-Identifier: GPL-3.0-or-later
// The evaluation of a cloud or mesh, and of a depth map, and the rendering of a mesh without truth.
// Each function prints its table, writes the files that the options name, and returns the content
// of the JSON file.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "base/context.h"
#include "options.h"

namespace axial::apps {

nlohmann::ordered_json run_cloud(const Options& options, const Context& context);
nlohmann::ordered_json run_rendering(const Options& options, const Context& context);
nlohmann::ordered_json run_depth_map(const Options& options, const Context& context);

}  // namespace axial::apps
