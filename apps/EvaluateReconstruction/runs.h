// SPDX-License-Identifier: GPL-3.0-or-later
// The evaluation of a cloud or mesh (run_cloud), and of a depth map (run_depth_map). Both functions
// print their tables, write the files that the options name, and return the content of the JSON
// file.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "options.h"

namespace axial::apps {

nlohmann::ordered_json run_cloud(const Options& options);
nlohmann::ordered_json run_depth_map(const Options& options);

}  // namespace axial::apps
