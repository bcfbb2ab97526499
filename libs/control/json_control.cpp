// SPDX-License-Identifier: GPL-3.0-or-later
// Our JSON: targets.json, and files of points and bars.
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/error.h"
#include "io/bytes/json.h"
#include "io/bytes/json_place.h"
#include "private/readers.h"
#include "private/stated_points.h"

namespace axial::control {
namespace {

using io::JsonPlace;
using nlohmann::json;

std::array<Eigen::Vector2d, 4> corners_of(const JsonPlace& place) {
  const std::vector<JsonPlace> list = place.elements();
  if (list.size() != 4) place.refuse("four lists of x, y and sigma");
  std::array<Eigen::Vector2d, 4> corners;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::vector<JsonPlace> corner = list[i].elements();
    if (corner.size() < 2) list[i].refuse("x, y and sigma");
    corners[i] = {corner[0].number(), corner[1].number()};
  }
  return corners;
}

TargetImage image_of(const JsonPlace& entry) {
  TargetImage image;
  image.label = entry.name("label");
  image.image = entry.name("image");
  image.pixel = {entry.number("x"), entry.number("y")};
  image.sigma = entry.has_value("sigma") ? entry.at("sigma").number_from_0() : 0;
  image.where = entry.where;
  if (entry.has_value("dot")) {
    const Eigen::Vector3d dot = entry.at("dot").vector();
    image.dot << dot[0], dot[1], dot[1], dot[2];
  }
  if (entry.has_value("corners")) image.corners = corners_of(entry.at("corners"));
  return image;
}

Eigen::Vector3d sigma_of(const JsonPlace& entry) {
  if (!entry.has_value("sigma")) return Eigen::Vector3d::Zero();
  const JsonPlace sigma = entry.at("sigma");
  if (sigma.json.is_array()) return sigma.vector();
  return Eigen::Vector3d::Constant(sigma.number());
}

StatedPoint point_of(const JsonPlace& entry) {
  entry.require_object(
      {"label", "x", "y", "z", "longitude", "latitude", "height", "depth", "sigma", "check"});
  StatedPoint point;
  point.label = entry.name("label");
  point.where = entry.where;
  const auto take = [&](std::initializer_list<const char*> keys, int coordinate) {
    const char* used = nullptr;
    for (const char* key : keys) {
      if (!entry.has_value(key)) continue;
      if (used) fail("{} has both {} and {}", entry.where, used, key);
      used = key;
      point.place[coordinate] = entry.number(key);
    }
  };
  take({"x", "longitude"}, 0);
  take({"y", "latitude"}, 1);
  take({"z", "height", "depth"}, 2);
  point.is_depth = entry.has_value("depth");
  point.sigma = sigma_of(entry);
  point.check = entry.flag_or_false("check");
  return point;
}

Bar bar_of(const JsonPlace& entry) {
  entry.require_object({"targets", "length", "sigma", "check"});
  const std::vector<JsonPlace> targets = entry.elements("targets");
  if (targets.size() != 2) entry.at("targets").refuse("a list of two labels");
  return {targets[0].text(),
          targets[1].text(),
          entry.number("length"),
          entry.number_or("sigma", 0),
          entry.flag_or_false("check"),
          entry.where};
}

// Nothing, or whether all coordinates are degrees.
void note_degrees(const JsonPlace& entry, std::optional<bool>& degrees) {
  const bool here = entry.has_value("longitude") || entry.has_value("latitude");
  const bool metres = entry.has_value("x") || entry.has_value("y");
  if (!here && !metres) return;
  if (here == metres || degrees.value_or(here) != here)
    fail_in(entry.where, "x and y are beside longitude and latitude; a file has one of both");
  degrees = here;
}

}  // namespace

Control read_json_control(const std::string& text, const std::filesystem::path& file,
                          const ControlReading& options) {
  const std::string name = file.string();
  const json content = io::parse_json(text, name);
  if (!content.contains("targets") && !content.contains("points") && !content.contains("bars"))
    fail_in(name, "has no targets, no points and no bars");
  Control control;
  const JsonPlace whole = JsonPlace::of_file(content, file);
  for (const JsonPlace& entry : whole.elements_or_none("targets"))
    control.images.push_back(image_of(entry));
  StatedPoints stated;
  std::optional<bool> degrees;
  for (const JsonPlace& entry : whole.elements_or_none("points")) {
    note_degrees(entry, degrees);
    stated.points.push_back(point_of(entry));
  }
  stated.degrees = degrees.value_or(false);
  if (whole.has_value("crs")) stated.crs = whole.name("crs");
  stated.crs_where = name + ": crs";
  add_points(std::move(stated), file, options, control);
  for (const JsonPlace& entry : whole.elements_or_none("bars"))
    add_bar(bar_of(entry), options, control);
  return control;
}

}  // namespace axial::control
