// SPDX-License-Identifier: GPL-3.0-or-later
// Our JSON: targets.json, and files of points and bars.
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/error.h"
#include "io/bytes/json.h"
#include "io/bytes/json_entry.h"
#include "private/readers.h"
#include "private/stated_points.h"

namespace axial::control {
namespace {

using nlohmann::json;

std::array<Eigen::Vector2d, 4> corners_of(const io::Entry& entry) {
  constexpr const char* kExpected = "four lists of x, y and sigma";
  const json* value = entry.find("corners");
  if (!value->is_array() || value->size() != 4) entry.refuse("corners", kExpected);
  std::array<Eigen::Vector2d, 4> corners;
  for (std::size_t i = 0; i < 4; ++i) {
    const json& corner = (*value)[i];
    if (!corner.is_array() || corner.size() < 2) entry.refuse("corners", kExpected);
    for (std::size_t k = 0; k < 2; ++k) {
      if (!io::is_finite_number(corner[k])) entry.refuse("corners", kExpected);
      corners[i][static_cast<Eigen::Index>(k)] = corner[k].get<double>();
    }
  }
  return corners;
}

TargetImage image_of(const io::Entry& entry) {
  TargetImage image;
  image.label = entry.text("label");
  image.image = entry.text("image");
  image.pixel = {entry.number("x"), entry.number("y")};
  image.sigma = entry.number_or("sigma", 0);
  image.where = entry.where;
  if (!(image.sigma >= 0)) entry.refuse("sigma", "0 or more");
  if (entry.has("dot")) {
    const auto dot = entry.numbers("dot", 3, "three finite numbers");
    image.dot << dot[0], dot[1], dot[1], dot[2];
  }
  if (entry.has("corners")) image.corners = corners_of(entry);
  return image;
}

Eigen::Vector3d sigma_of(const io::Entry& entry) {
  const json* value = entry.find("sigma");
  if (value && value->is_array()) {
    const auto list = entry.numbers("sigma", 3, "a number, or three");
    return {list[0], list[1], list[2]};
  }
  return Eigen::Vector3d::Constant(entry.number_or("sigma", 0));
}

StatedPoint point_of(const io::Entry& entry) {
  entry.require_known(
      {"label", "x", "y", "z", "longitude", "latitude", "height", "depth", "sigma", "check"});
  StatedPoint point;
  point.label = entry.text("label");
  point.where = entry.where;
  const auto take = [&](std::initializer_list<const char*> keys, int coordinate) {
    const char* used = nullptr;
    for (const char* key : keys) {
      if (!entry.has(key)) continue;
      if (used) fail("{} has both {} and {}", entry.where, used, key);
      used = key;
      point.place[coordinate] = entry.number(key);
    }
  };
  take({"x", "longitude"}, 0);
  take({"y", "latitude"}, 1);
  take({"z", "height", "depth"}, 2);
  point.is_depth = entry.has("depth");
  point.sigma = sigma_of(entry);
  point.check = entry.flag("check");
  return point;
}

Bar bar_of(const io::Entry& entry) {
  entry.require_known({"targets", "length", "sigma", "check"});
  const json* targets = entry.find("targets");
  if (!targets || !targets->is_array() || targets->size() != 2 || !(*targets)[0].is_string() ||
      !(*targets)[1].is_string())
    entry.refuse("targets", "a list of two labels");
  return {(*targets)[0].get<std::string>(),
          (*targets)[1].get<std::string>(),
          entry.number("length"),
          entry.number_or("sigma", 0),
          entry.flag("check"),
          entry.where};
}

// Nothing, or whether all coordinates are degrees.
void note_degrees(const io::Entry& entry, std::optional<bool>& degrees) {
  const bool here = entry.has("longitude") || entry.has("latitude");
  const bool metres = entry.has("x") || entry.has("y");
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
  io::for_each_entry(content, name, "targets",
                     [&](const io::Entry& entry) { control.images.push_back(image_of(entry)); });
  StatedPoints stated;
  std::optional<bool> degrees;
  io::for_each_entry(content, name, "points", [&](const io::Entry& entry) {
    note_degrees(entry, degrees);
    stated.points.push_back(point_of(entry));
  });
  stated.degrees = degrees.value_or(false);
  const io::Entry whole{content, name + ": control"};
  if (whole.has("crs")) stated.crs = whole.text("crs");
  stated.crs_where = name + ": crs";
  add_points(std::move(stated), file, options, control);
  io::for_each_entry(content, name, "bars",
                     [&](const io::Entry& entry) { add_bar(bar_of(entry), options, control); });
  return control;
}

}  // namespace axial::control
