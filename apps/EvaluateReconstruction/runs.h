// SPDX-License-Identifier: GPL-3.0-or-later
// The two things the program evaluates. Both print their table, write what the options ask for and
// return what goes into the JSON file.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "options.h"

nlohmann::ordered_json run_cloud(const Options& options);
nlohmann::ordered_json run_depth_map(const Options& options);
