// SPDX-License-Identifier: GPL-3.0-or-later
#include "private/cameras/lens_json.h"

#include <nlohmann/json.hpp>
#include <span>

#include "base/error.h"

namespace axial::io {
namespace {

// Reads a list into the first elements of `numbers`.
void read_list(const JsonPlace& place, const char* key, std::span<double> numbers) {
  if (!place.has(key)) return;
  const nlohmann::json& list = place.json.at(key);
  if (!list.is_array() || list.size() > numbers.size())
    fail("{}.{} is {}, expected at most {} numbers", place.where, key, to_text(list),
         numbers.size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (!list[i].is_number()) fail("{}.{}[{}] is not a number", place.where, key, i);
    numbers[i] = list[i].get<double>();
  }
}

double read_type(const JsonPlace& place) {
  const std::string type = place.text("type");
  if (type != "perspective" && type != "fisheye")
    fail("{}.type is '{}', expected 'perspective' or 'fisheye'", place.where, type);
  return type == "fisheye" ? 1 : 0;
}

}  // namespace

refractive::LensDistortion<double> distortion_from_json(const JsonPlace& place) {
  place.require_object({"type", "spread", "radial", "radial_below", "tangential", "thin_prism"});
  refractive::LensDistortion<double> lens;
  lens.fisheye = read_type(place);
  if (place.has("spread")) lens.spread = place.number("spread");
  read_list(place, "radial", lens.above);
  read_list(place, "radial_below", lens.below);
  double tangential[] = {0, 0};
  read_list(place, "tangential", tangential);
  lens.p1 = tangential[0];
  lens.p2 = tangential[1];
  read_list(place, "thin_prism", {lens.prism.data(), 2});
  if (!(lens.spread > 0))
    fail("{}.spread is {}, expected a positive number", place.where, lens.spread);
  if (!(lens.above[0] > 0))
    fail("{}.radial begins with {}, expected a positive number", place.where, lens.above[0]);
  return lens;
}

nlohmann::json distortion_to_json(const refractive::LensDistortion<double>& lens) {
  return {{"type", lens.fisheye > 0 ? "fisheye" : "perspective"},
          {"spread", lens.spread},
          {"radial", lens.above},
          {"radial_below", lens.below},
          {"tangential", {lens.p1, lens.p2}},
          {"thin_prism", {lens.prism.x(), lens.prism.y()}}};
}

}  // namespace axial::io
