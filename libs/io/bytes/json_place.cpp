// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/bytes/json_place.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "io/bytes/json.h"

namespace axial::io {

bool is_finite_number(const nlohmann::json& value) {
  return value.is_number() && std::isfinite(value.get<double>());
}

namespace {

bool is_whole(const JsonPlace& place) {
  return place.where.ends_with(':');
}

std::string place_at(const JsonPlace& object, const std::string& key) {
  return object.where + (is_whole(object) ? " " : ".") + key;
}

}  // namespace

JsonPlace JsonPlace::of_file(const nlohmann::json& content, const std::filesystem::path& file) {
  return {content, file.string() + ":"};
}

void JsonPlace::refuse(const std::string& expected) const {
  constexpr std::size_t kLongest = 60;
  std::string found = to_text(json);
  if (found.size() > kLongest) found = found.substr(0, kLongest) + "...";
  fail("{} is {}, expected {}", where, found, expected);
}

double JsonPlace::number() const {
  if (!is_finite_number(json)) refuse("a number");
  return json.get<double>();
}

double JsonPlace::number_from_0() const {
  if (number() < 0) refuse("a number of at least 0");
  return number();
}

std::string JsonPlace::text() const {
  if (!json.is_string()) refuse("a text");
  return json.get<std::string>();
}

std::string JsonPlace::name() const {
  if (text().empty()) refuse("a text that is not empty");
  return text();
}

bool JsonPlace::flag() const {
  if (!json.is_boolean()) refuse("true or false");
  return json.get<bool>();
}

std::vector<double> JsonPlace::numbers(std::size_t count) const {
  if (!json.is_array() || json.size() != count || !std::ranges::all_of(json, is_finite_number))
    refuse(fmt::format("{} numbers", count));
  return json.get<std::vector<double>>();
}

Eigen::Vector3d JsonPlace::vector() const {
  const std::vector<double> coordinates = numbers(3);
  return Eigen::Vector3d(coordinates.data());
}

std::vector<JsonPlace> JsonPlace::elements() const {
  if (!json.is_array()) refuse("a list");
  std::vector<JsonPlace> all;
  for (const nlohmann::json& element : json)
    all.push_back({element, fmt::format("{}[{}]", where, all.size())});
  return all;
}

std::vector<std::string> JsonPlace::keys() const {
  if (!json.is_object()) refuse("an object in braces");
  std::vector<std::string> keys;
  for (const auto& item : json.items()) keys.push_back(item.key());
  return keys;
}

bool JsonPlace::has(const char* key) const {
  return json.contains(key);
}

bool JsonPlace::has_value(const char* key) const {
  return has(key) && !json[key].is_null();
}

JsonPlace JsonPlace::at(const std::string& key) const {
  if (!json.is_object()) refuse("an object in braces");
  const auto found = json.find(key);
  if (found == json.end()) fail("{} is missing", place_at(*this, key));
  return {*found, place_at(*this, key)};
}

double JsonPlace::number_or(const char* key, double otherwise) const {
  return has_value(key) ? number(key) : otherwise;
}

bool JsonPlace::flag_or_false(const char* key) const {
  return has_value(key) && flag(key);
}

std::vector<JsonPlace> JsonPlace::elements_or_none(const char* key) const {
  return has_value(key) ? elements(key) : std::vector<JsonPlace>();
}

void JsonPlace::require_object(std::initializer_list<std::string_view> known) const {
  for (const std::string& key : keys())
    if (std::ranges::find(known, key) == known.end())
      fail("{}{} unknown key '{}'", where, is_whole(*this) ? "" : ":", key);
}

void JsonPlace::require_version_1() const {
  if (const JsonPlace version = at("version"); version.json != 1) version.refuse("1");
}

}  // namespace axial::io
