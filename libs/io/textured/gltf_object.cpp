// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "io/bytes/json.h"
#include "textured/private/gltf_file.h"

namespace axial::io {
namespace {

using Json = nlohmann::json;

std::string shortened(const Json& json) {
  constexpr std::size_t kLongest = 60;
  const std::string text = to_text(json);
  return text.size() <= kLongest ? text : fmt::format("{}...", text.substr(0, kLongest));
}

// JSON does not distinguish 4 and 4.0.
std::optional<std::size_t> whole_number(const Json& json) {
  if (json.is_number_unsigned()) return json.get<std::size_t>();
  constexpr double kExact = 9007199254740992.0;  // 2^53
  const double value = json.is_number_float() ? json.get<double>() : -1;
  if (!(value >= 0 && value < kExact) || value != std::trunc(value)) return {};
  return static_cast<std::size_t>(value);
}

std::optional<double> finite_number(const Json& json) {
  const double number = json.is_number() ? json.get<double>() : NAN;
  return std::isfinite(number) ? std::optional(number) : std::nullopt;
}

std::optional<std::string> text_in(const Json& json) {
  return json.is_string() ? std::optional(json.get<std::string>()) : std::nullopt;
}

std::optional<bool> flag_in(const Json& json) {
  return json.is_boolean() ? std::optional(json.get<bool>()) : std::nullopt;
}

// The items of a list, each read by `item`.
template <class Item>
auto list_of(std::optional<Item> (*item)(const Json&)) {
  return [item](const Json& json) -> std::optional<std::vector<Item>> {
    std::vector<Item> items;
    if (!json.is_array() && !json.empty()) return {};
    for (const Json& entry : json) {
      const std::optional<Item> one = item(entry);
      if (!one) return {};
      items.push_back(*one);
    }
    return items;
  };
}

}  // namespace

GltfObject::GltfObject(const std::string& file, std::string name, const Json& json)
    : file_(&file), name_(std::move(name)), json_(&json) {
  if (!json.is_object()) fail_in(file, "{} is not an object", name_);
}

void GltfObject::refuse(std::string_view text) const {
  fail_in(*file_, "{} {}", name_, text);
}

const Json* GltfObject::value(const char* key) const {
  const auto found = json_->find(key);
  return found == json_->end() ? nullptr : &*found;
}

template <class Read>
auto GltfObject::read(const char* key, std::string_view kind, Read take) const
    -> decltype(take(*json_)) {
  const Json* json = value(key);
  if (!json) return {};
  auto result = take(*json);
  if (!result) fail_in(*file_, "{}.{} is {}, which is not {}", name_, key, shortened(*json), kind);
  return result;
}

std::optional<std::size_t> GltfObject::index(const char* key) const {
  return read(key, "a whole number of at least 0", whole_number);
}

std::size_t GltfObject::needed_index(const char* key) const {
  const auto number = index(key);
  if (!number) fail_in(*file_, "{} has no {}", name_, key);
  return *number;
}

std::vector<std::size_t> GltfObject::indices(const char* key) const {
  return read(key, "a list of whole numbers of at least 0", list_of(whole_number))
      .value_or(std::vector<std::size_t>());
}

std::optional<double> GltfObject::number(const char* key) const {
  return read(key, "a number", finite_number);
}

std::vector<double> GltfObject::numbers(const char* key, std::size_t size) const {
  const auto list_of_size = [size](const Json& json) {
    auto list = list_of(finite_number)(json);
    if (!json.is_array() || (list && size > 0 && list->size() != size)) list.reset();
    return list;
  };
  const std::string kind =
      size > 0 ? fmt::format("a list of {} numbers", size) : "a list of numbers";
  return read(key, kind, list_of_size).value_or(std::vector<double>());
}

std::optional<std::string> GltfObject::text(const char* key) const {
  return read(key, "a text", text_in);
}

std::vector<std::string> GltfObject::texts(const char* key) const {
  return read(key, "a list of texts", list_of(text_in)).value_or(std::vector<std::string>());
}

bool GltfObject::flag(const char* key) const {
  return read(key, "true or false", flag_in).value_or(false);
}

std::optional<GltfObject> GltfObject::object(const char* key) const {
  const Json* json = value(key);
  if (!json) return {};
  return GltfObject(*file_, fmt::format("{}.{}", name_, key), *json);
}

std::optional<GltfObject> GltfObject::extras() const {
  const Json* json = value("extras");
  return json && json->is_object() ? object("extras") : std::nullopt;
}

std::vector<GltfObject> GltfObject::objects(const char* key) const {
  std::vector<GltfObject> result;
  const Json* json = value(key);
  if (!json) return result;
  if (!json->is_array()) fail_in(*file_, "{}.{} is not a list", name_, key);
  for (const Json& entry : *json)
    result.emplace_back(*file_, fmt::format("{}.{}[{}]", name_, key, result.size()), entry);
  return result;
}

std::optional<GltfObject> GltfObject::extension(const char* key) const {
  const auto extensions = object("extensions");
  return extensions ? extensions->object(key) : std::nullopt;
}

std::vector<std::string> GltfObject::keys() const {
  std::vector<std::string> result;
  for (const auto& [key, ignored] : json_->items()) result.push_back(key);
  return result;
}

}  // namespace axial::io
