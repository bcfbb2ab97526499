// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

namespace axial::apps {

// The run of `reconstruct` for the page, from the file that `reconstruct` wrote
// (docs/view.md): "command", a list of words, and "steps", a list of objects with "name",
// "command", "seconds", "version" (a text or null) and "warnings", a list of "text" and "times";
// with bars and control points also "control", a list of their rows. Error that names the file and
// the field if the file is missing or malformed.
nlohmann::ordered_json run_report(const std::filesystem::path& file);

}  // namespace axial::apps
