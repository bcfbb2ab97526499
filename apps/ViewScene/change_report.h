// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

namespace axial::apps {

// The part of the report of CompareSurveys (docs/compare.md) that the page shows: "before",
// "after", "area_compared", "came", "gone", "net", and the first regions with "of_regions", their
// number in the report. Error that names the file and the field if the report is missing or
// malformed.
nlohmann::ordered_json change_report(const std::filesystem::path& file);

}  // namespace axial::apps
