// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/error.h"
#include "io/bytes/json.h"
#include "io/bytes/json_entry.h"
#include "labels/coco.h"

namespace axial::labels {
namespace {

namespace fs = std::filesystem;
using io::Entry;

std::int64_t integer(const Entry& entry, const char* key) {
  const nlohmann::json* value = entry.find(key);
  if (!value || !value->is_number_integer()) entry.refuse(key, "an integer");
  return value->get<std::int64_t>();
}

// The values of a list of entries, by the id of the entry.
template <class Value>
class ById {
 public:
  void add(const Entry& entry, Value value) {
    if (!values_.emplace(integer(entry, "id"), std::move(value)).second)
      entry.refuse("id", "an id that no entry before it has");
  }

  const Value& of(const Entry& entry, const char* key, const char* expected) const {
    const auto found = values_.find(integer(entry, key));
    if (found == values_.end()) entry.refuse(key, expected);
    return found->second;
  }

 private:
  std::map<std::int64_t, Value> values_;
};

int side(const Entry& entry, const char* key) {
  const std::int64_t value = integer(entry, key);
  if (value < 1 || value > 1'000'000) entry.refuse(key, "a number of pixels from 1 to 1000000");
  return static_cast<int>(value);
}

// The numbers of a list whose length is a multiple of `group` and at least `least`; COCO's
// coordinates x and y are at the begin of a group.
std::vector<double> coordinates(const nlohmann::json& list, const Entry& entry, const char* key,
                                std::size_t group, std::size_t least) {
  constexpr double kLargest = 1e6;
  // The list may be long: the message leaves it out.
  const auto refuse = [&](const char* expected) {
    fail("{}.{}: must have {}", entry.where, key, expected);
  };
  if (!list.is_array() || list.size() < least || list.size() % group != 0)
    refuse(group == 2 ? "lists x, y, ... of three corners or more"
                      : "x, y and visibility for each key point");
  std::vector<double> numbers;
  for (const nlohmann::json& item : list) {
    if (!io::is_finite_number(item) || std::abs(item.get<double>()) > kLargest)
      refuse("numbers up to 1e6");
    numbers.push_back(item.get<double>());
  }
  return numbers;
}

// From COCO's coordinates.
Eigen::Vector2d pixel_at(double x, double y) {
  return {x - 0.5, y - 0.5};
}

void add_polygons(const Entry& entry, map::Label& label) {
  const nlohmann::json* polygons = entry.find("segmentation");
  if (!polygons || !polygons->is_array()) return;  // a bitmap is an object
  for (const nlohmann::json& polygon : *polygons) {
    const std::vector<double> numbers = coordinates(polygon, entry, "segmentation", 2, 6);
    geometry::Ring ring;
    for (std::size_t i = 0; i < numbers.size(); i += 2)
      ring.push_back(pixel_at(numbers[i], numbers[i + 1]));
    label.parts.push_back({std::move(ring)});
  }
}

void add_key_points(const Entry& entry, map::Label& label) {
  const nlohmann::json* list = entry.find("keypoints");
  if (!list) return;
  const std::vector<double> numbers = coordinates(*list, entry, "keypoints", 3, 0);
  for (std::size_t i = 0; i < numbers.size(); i += 3)
    if (numbers[i + 2] > 0) label.points.push_back(pixel_at(numbers[i], numbers[i + 1]));
}

std::string name_of(const Entry& entry, const std::string& category) {
  const nlohmann::json* attributes = entry.find("attributes");
  if (!attributes || !attributes->is_object()) return category;
  const auto name = attributes->find("name");
  if (name == attributes->end() || !name->is_string()) return category;
  return name->get<std::string>();
}

}  // namespace

CocoLabels read_coco(const fs::path& file) {
  const nlohmann::json json = io::read_json(file);
  for (const char* key : {"images", "annotations", "categories"})
    if (!json.is_object() || !json.contains(key))
      fail_in(file, "is no COCO file: it has no list '{}'", key);
  CocoLabels read;
  ById<std::size_t> images;
  ById<std::string> categories;
  io::for_each_entry(json, file.string(), "images", [&](const Entry& entry) {
    images.add(entry, read.photographs.size());
    read.photographs.push_back(
        {entry.text("file_name"), side(entry, "width"), side(entry, "height"), {}});
  });
  io::for_each_entry(json, file.string(), "categories",
                     [&](const Entry& entry) { categories.add(entry, entry.text("name")); });
  io::for_each_entry(json, file.string(), "annotations", [&](const Entry& entry) {
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
  });
  return read;
}

}  // namespace axial::labels
