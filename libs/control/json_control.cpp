// SPDX-License-Identifier: GPL-3.0-or-later
// Our JSON: targets.json, and files of points and bars.
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "base/error.h"
#include "io/bytes/json.h"
#include "private/readers.h"
#include "private/stated_points.h"

namespace axial::control {
namespace {

using nlohmann::json;

// An object of the file and its place, for messages.
struct Entry {
  const json& object;
  std::string where;

  const json* find(const char* key) const {
    const auto found = object.find(key);
    return found == object.end() || found->is_null() ? nullptr : &*found;
  }
  bool has(const char* key) const { return find(key) != nullptr; }
  [[noreturn]] void refuse(const char* key, const char* expected) const {
    const json* value = find(key);
    fail("{}.{} is {}, but must be {}", where, key, value ? io::to_text(*value) : "missing",
         expected);
  }
  double number(const char* key) const {
    const json* value = find(key);
    if (!value || !value->is_number() || !std::isfinite(value->get<double>()))
      refuse(key, "a finite number");
    return value->get<double>();
  }
  double number_or(const char* key, double otherwise) const {
    return has(key) ? number(key) : otherwise;
  }
  std::string text(const char* key) const {
    const json* value = find(key);
    if (!value || !value->is_string() || value->get_ref<const std::string&>().empty())
      refuse(key, "a text");
    return value->get<std::string>();
  }
  bool flag(const char* key) const {
    const json* value = find(key);
    if (value && !value->is_boolean()) refuse(key, "true or false");
    return value && value->get<bool>();
  }
  // The numbers of a list of this length.
  std::vector<double> numbers(const char* key, std::size_t count, const char* expected) const {
    const json* value = find(key);
    if (!value || !value->is_array() || value->size() != count) refuse(key, expected);
    std::vector<double> result;
    for (const json& item : *value) {
      if (!item.is_number() || !std::isfinite(item.get<double>())) refuse(key, expected);
      result.push_back(item.get<double>());
    }
    return result;
  }
  void require_known(std::initializer_list<std::string_view> keys) const {
    for (const auto& item : object.items())
      if (std::ranges::find(keys, item.key()) == keys.end())
        fail("{}.{} is no key of the format", where, item.key());
  }
};

// Calls use(entry) for each object of the list at `key`.
template <class Use>
void for_each_entry(const json& file, const std::string& name, const char* key, Use use) {
  const auto found = file.find(key);
  if (found == file.end()) return;
  if (!found->is_array()) fail_in(name, "{} must be a list", key);
  for (std::size_t i = 0; i < found->size(); ++i) {
    const Entry entry{(*found)[i], fmt::format("{}: {}[{}]", name, key, i)};
    if (!entry.object.is_object()) fail("{} must be an object", entry.where);
    use(entry);
  }
}

std::array<Eigen::Vector2d, 4> corners_of(const Entry& entry) {
  constexpr const char* kExpected = "four lists of x, y and sigma";
  const json* value = entry.find("corners");
  if (!value->is_array() || value->size() != 4) entry.refuse("corners", kExpected);
  std::array<Eigen::Vector2d, 4> corners;
  for (std::size_t i = 0; i < 4; ++i) {
    const json& corner = (*value)[i];
    if (!corner.is_array() || corner.size() < 2) entry.refuse("corners", kExpected);
    for (std::size_t k = 0; k < 2; ++k) {
      if (!corner[k].is_number() || !std::isfinite(corner[k].get<double>()))
        entry.refuse("corners", kExpected);
      corners[i][static_cast<Eigen::Index>(k)] = corner[k].get<double>();
    }
  }
  return corners;
}

TargetImage image_of(const Entry& entry) {
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

Eigen::Vector3d sigma_of(const Entry& entry) {
  const json* value = entry.find("sigma");
  if (value && value->is_array()) {
    const auto list = entry.numbers("sigma", 3, "a number, or three");
    return {list[0], list[1], list[2]};
  }
  return Eigen::Vector3d::Constant(entry.number_or("sigma", 0));
}

StatedPoint point_of(const Entry& entry) {
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

Bar bar_of(const Entry& entry) {
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
void note_degrees(const Entry& entry, std::optional<bool>& degrees) {
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
  for_each_entry(content, name, "targets",
                 [&](const Entry& entry) { control.images.push_back(image_of(entry)); });
  StatedPoints stated;
  std::optional<bool> degrees;
  for_each_entry(content, name, "points", [&](const Entry& entry) {
    note_degrees(entry, degrees);
    stated.points.push_back(point_of(entry));
  });
  stated.degrees = degrees.value_or(false);
  const Entry whole{content, name + ": control"};
  if (whole.has("crs")) stated.crs = whole.text("crs");
  stated.crs_where = name + ": crs";
  add_points(std::move(stated), file, options, control);
  for_each_entry(content, name, "bars",
                 [&](const Entry& entry) { add_bar(bar_of(entry), options, control); });
  return control;
}

}  // namespace axial::control
