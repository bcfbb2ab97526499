// SPDX-License-Identifier: GPL-3.0-or-later
#include "change_report.h"

#include <algorithm>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <vector>

#include "io/bytes/json.h"
#include "io/bytes/json_place.h"

namespace axial::apps {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostRegions = 50;  // in the table of the page

Json volume_of(const io::JsonPlace& field) {
  return {{"volume", field.number("volume")},
          {"volume_sigma", field.at("volume_sigma").number_from_0()}};
}

Json size_of(const io::JsonPlace& field) {
  Json size = volume_of(field);
  size["area"] = field.at("area").number_from_0();
  return size;
}

Json region_of(const io::JsonPlace& field) {
  Json region = size_of(field);
  const io::JsonPlace change = field.at("change");
  if (change.text() != "came" && change.text() != "gone") change.refuse("came or gone");
  region["change"] = change.text();
  region["largest_difference"] = field.number("largest_difference");
  region["x"] = field.number("x");
  region["y"] = field.number("y");
  return region;
}

}  // namespace

Json change_report(const std::filesystem::path& file) {
  const nlohmann::json content = io::read_json(file);
  const io::JsonPlace whole = io::JsonPlace::of_file(content, file);
  Json report{{"before", whole.text("before")},
              {"after", whole.text("after")},
              {"area_compared", whole.at("area_compared").number_from_0()},
              {"came", size_of(whole.at("came"))},
              {"gone", size_of(whole.at("gone"))},
              {"net", volume_of(whole.at("net"))},
              {"regions", Json::array()}};
  const std::vector<io::JsonPlace> regions = whole.elements("regions");
  for (std::size_t i = 0; i < std::min(regions.size(), kMostRegions); ++i)
    report["regions"].push_back(region_of(regions[i]));
  report["of_regions"] = regions.size();
  return report;
}

}  // namespace axial::apps
