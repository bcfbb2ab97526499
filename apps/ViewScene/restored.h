// SPDX-License-Identifier: GPL-3.0-or-later
// What RestoreColors found about water and light, and its pictures, for the page.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "base/context.h"
#include "survey/survey.h"

namespace axial::apps {

// Writes pictures of up to six photographs, evenly spread over the views, to the folder "colors" of
// `staging`: as they were taken, and of View::colors, which all views must have. Returns an object
// with "pictures", a list of objects with "name", "before" and "after" (files below `staging`).
//
// If Options::color_folder has the file colors.json (docs/formats.md, "Colours without water"), the
// object also has "light" and "white", texts; "spread_before" and "spread_after"; "channels", a
// list of objects with "name", "determined", "assumed" and "values", of which each has "name",
// "unit", "value" and "sigma" (null: not known); and, if the file has them, "water", the type of
// water, and "by_way": a list of objects with "way_m", "before" and "after", the last two of R, G
// and B. Error that names the file and the field if it is malformed.
nlohmann::ordered_json restored_colors(const survey::Survey& survey,
                                       const std::filesystem::path& staging,
                                       const Context& context);

}  // namespace axial::apps
