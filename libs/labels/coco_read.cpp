// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/error.h"
#include "io/bytes/json.h"
#include "io/bytes/json_place.h"
#include "labels/coco.h"

namespace axial::labels {
namespace {

namespace fs = std::filesystem;
using io::JsonPlace;

std::int64_t integer(const JsonPlace& entry, const char* key) {
  const JsonPlace value = entry.at(key);
  if (!value.json.is_number_integer()) value.refuse("an integer");
  return value.json.get<std::int64_t>();
}

// The values of a list of entries, by the id of the entry.
template <class Value>
class ById {
 public:
  void add(const JsonPlace& entry, Value value) {
    if (!values_.emplace(integer(entry, "id"), std::move(value)).second)
      entry.at("id").refuse("an id that no entry before it has");
  }

  const Value& of(const JsonPlace& entry, const char* key, const char* expected) const {
    const auto found = values_.find(integer(entry, key));
    if (found == values_.end()) entry.at(key).refuse(expected);
    return found->second;
  }

 private:
  std::map<std::int64_t, Value> values_;
};

int side(const JsonPlace& entry, const char* key) {
  const std::int64_t value = integer(entry, key);
  if (value < 1 || value > 1'000'000) entry.at(key).refuse("a number of pixels from 1 to 1000000");
  return static_cast<int>(value);
}

// The numbers of a list whose length is a multiple of `group` and at least `least`; COCO's
// coordinates x and y are at the begin of a group.
std::vector<double> coordinates(const JsonPlace& list, std::size_t group, std::size_t least) {
  constexpr double kLargest = 1e6;
  const std::size_t count = list.json.size();
  if (!list.json.is_array() || count < least || count % group != 0)
    list.refuse(group == 2 ? "x, y, ... of three corners or more"
                           : "x, y and visibility for each key point");
  std::vector<double> numbers = list.numbers(count);
  if (std::ranges::any_of(numbers, [](double x) { return std::abs(x) > kLargest; }))
    list.refuse("numbers up to 1e6");
  return numbers;
}

// From COCO's coordinates.
Eigen::Vector2d pixel_at(double x, double y) {
  return {x - 0.5, y - 0.5};
}

void add_polygons(const JsonPlace& entry, map::Label& label) {
  const char* key = "segmentation";
  if (!entry.has_value(key) || !entry.at(key).json.is_array()) return;  // a bitmap is an object
  for (const JsonPlace& polygon : entry.elements(key)) {
    const std::vector<double> numbers = coordinates(polygon, 2, 6);
    geometry::Ring ring;
    for (std::size_t i = 0; i < numbers.size(); i += 2)
      ring.push_back(pixel_at(numbers[i], numbers[i + 1]));
    label.parts.push_back({std::move(ring)});
  }
}

void add_key_points(const JsonPlace& entry, map::Label& label) {
  if (!entry.has_value("keypoints")) return;
  const std::vector<double> numbers = coordinates(entry.at("keypoints"), 3, 0);
  for (std::size_t i = 0; i < numbers.size(); i += 3)
    if (numbers[i + 2] > 0) label.points.push_back(pixel_at(numbers[i], numbers[i + 1]));
}

std::string name_of(const JsonPlace& entry, const std::string& category) {
  if (!entry.has_value("attributes")) return category;
  const JsonPlace attributes = entry.at("attributes");
  if (!attributes.has_value("name") || !attributes.at("name").json.is_string()) return category;
  return attributes.text("name");
}

}  // namespace

CocoLabels read_coco(const fs::path& file) {
  const nlohmann::json json = io::read_json(file);
  for (const char* key : {"images", "annotations", "categories"})
    if (!json.is_object() || !json.contains(key))
      fail_in(file, "is no COCO file: it has no list '{}'", key);
  const JsonPlace whole = JsonPlace::of_file(json, file);
  CocoLabels read;
  ById<std::size_t> images;
  ById<std::string> categories;
  for (const JsonPlace& entry : whole.elements("images")) {
    images.add(entry, read.photographs.size());
    read.photographs.push_back(
        {entry.name("file_name"), side(entry, "width"), side(entry, "height"), {}});
  }
  for (const JsonPlace& entry : whole.elements("categories"))
    categories.add(entry, entry.name("name"));
  for (const JsonPlace& entry : whole.elements("annotations")) {
    const std::size_t image = images.of(entry, "image_id", "the id of an image");
    map::Label label;
    label.category = categories.of(entry, "category_id", "the id of a category");
    label.name = name_of(entry, label.category);
    add_polygons(entry, label);
    add_key_points(entry, label);
    if (label.parts.empty() && label.points.empty())
      ++read.left_out;
    else
      read.photographs[image].labels.push_back(std::move(label));
  }
  return read;
}

}  // namespace axial::labels
