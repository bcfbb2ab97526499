// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/targets_file.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "io/bytes/json.h"

namespace axial::targets {
namespace {

using nlohmann::json;

// Far below the precision of a pixel; the file stays readable.
double rounded(double value) {
  return std::round(value * 1e4) / 1e4;
}

json corner_json(const ImagePoint& point) {
  return {rounded(point.pixel.x()), rounded(point.pixel.y()), rounded(point.sigma)};
}

json target_json(const std::string& image, const Detection& target) {
  json result = {{"label", target.label},
                 {"code", target.code},
                 {"image", image},
                 {"x", rounded(target.centre.pixel.x())},
                 {"y", rounded(target.centre.pixel.y())},
                 {"sigma", rounded(target.centre.sigma)},
                 {"width", rounded(target.width)},
                 {"agreement", rounded(target.agreement)}};
  if (target.corners)
    for (const ImagePoint& corner : *target.corners)
      result["corners"].push_back(corner_json(corner));
  else if (!target.dot.isZero(0))
    result["dot"] = {target.dot(0, 0), target.dot(0, 1), target.dot(1, 1)};
  return result;
}

}  // namespace

void write_targets(const std::filesystem::path& path, std::span<const Family> families,
                   std::span<const Photograph> photographs) {
  json file = {{"pixels", "the corner of the first pixel is (0, 0), its centre is (0.5, 0.5)"},
               {"families", json::array()},
               {"images", json::array()},
               {"targets", json::array()}};
  for (const Family& family : families) file["families"].push_back(family.name);
  for (const Photograph& photograph : photographs) {
    file["images"].push_back({{"name", photograph.name},
                              {"width", photograph.size.width},
                              {"height", photograph.size.height}});
    for (const Detection& target : photograph.targets)
      file["targets"].push_back(target_json(photograph.name, target));
  }
  io::write_json(path, file);
}

}  // namespace axial::targets
