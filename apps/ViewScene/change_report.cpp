// SPDX-License-Identifier: GPL-3.0-or-later
#include "change_report.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "json_fields.h"

namespace axial::apps {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostRegions = 50;  // in the table of the page

Json volume_of(const JsonField& field) {
  return {{"volume", field.at("volume").number()},
          {"volume_sigma", field.at("volume_sigma").number_from_0()}};
}

Json size_of(const JsonField& field) {
  Json size = volume_of(field);
  size["area"] = field.at("area").number_from_0();
  return size;
}

Json region_of(const JsonField& field) {
  Json region = size_of(field);
  const JsonField change = field.at("change");
  if (change.text() != "came" && change.text() != "gone") change.refuse("came or gone");
  region["change"] = change.text();
  region["largest_difference"] = field.at("largest_difference").number();
  region["x"] = field.at("x").number();
  region["y"] = field.at("y").number();
  return region;
}

}  // namespace

Json change_report(const std::filesystem::path& file) {
  const JsonField whole{file, "", io::read_json(file)};
  Json report{{"before", whole.at("before").text()},
              {"after", whole.at("after").text()},
              {"area_compared", whole.at("area_compared").number_from_0()},
              {"came", size_of(whole.at("came"))},
              {"gone", size_of(whole.at("gone"))},
              {"net", volume_of(whole.at("net"))},
              {"regions", Json::array()}};
  const std::vector<JsonField> regions = whole.at("regions").elements();
  for (std::size_t i = 0; i < std::min(regions.size(), kMostRegions); ++i)
    report["regions"].push_back(region_of(regions[i]));
  report["of_regions"] = regions.size();
  return report;
}

}  // namespace axial::apps
