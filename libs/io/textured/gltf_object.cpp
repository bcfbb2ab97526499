// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "io/bytes/json.h"
#include "private/textured/gltf_file.h"

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

}  // namespace

GltfObject::GltfObject(const std::string& file, std::string name, const Json& json)
    : file_(&file), name_(std::move(name)), json_(&json) {
  if (!json.is_object()) fail("{}: {} is not an object", file, name_);
}

void GltfObject::refuse(std::string_view text) const {
  fail("{}: {} {}", *file_, name_, text);
}

const Json* GltfObject::value(const char* key) const {
  const auto found = json_->find(key);
  return found == json_->end() ? nullptr : &*found;
}

std::optional<std::size_t> GltfObject::index(const char* key) const {
  const Json* json = value(key);
  if (!json) return {};
  const auto number = whole_number(*json);
  if (!number)
    fail("{}: {}.{} is {}, which is not a whole number of at least 0", *file_, name_, key,
         shortened(*json));
  return number;
}

std::size_t GltfObject::needed_index(const char* key) const {
  const auto number = index(key);
  if (!number) fail("{}: {} has no {}", *file_, name_, key);
  return *number;
}

std::vector<std::size_t> GltfObject::indices(const char* key) const {
  std::vector<std::size_t> result;
  const Json* json = value(key);
  if (!json) return result;
  for (const Json& entry : *json) {
    const auto number = json->is_array() ? whole_number(entry) : std::nullopt;
    if (!number)
      fail("{}: {}.{} is {}, which is not a list of whole numbers of at least 0", *file_, name_,
           key, shortened(*json));
    result.push_back(*number);
  }
  return result;
}

std::optional<double> GltfObject::number(const char* key) const {
  const Json* json = value(key);
  if (!json) return {};
  const double number = json->is_number() ? json->get<double>() : NAN;
  if (!std::isfinite(number))
    fail("{}: {}.{} is {}, which is not a number", *file_, name_, key, shortened(*json));
  return number;
}

std::vector<double> GltfObject::numbers(const char* key, std::size_t size) const {
  std::vector<double> result;
  const Json* json = value(key);
  if (!json) return result;
  if (json->is_array())
    for (const Json& entry : *json)
      if (entry.is_number() && std::isfinite(entry.get<double>()))
        result.push_back(entry.get<double>());
  if (!json->is_array() || result.size() != json->size() || (size > 0 && result.size() != size))
    fail("{}: {}.{} is {}, which is not a list of {}numbers", *file_, name_, key, shortened(*json),
         size > 0 ? fmt::format("{} ", size) : "");
  return result;
}

std::optional<std::string> GltfObject::text(const char* key) const {
  const Json* json = value(key);
  if (!json) return {};
  if (!json->is_string())
    fail("{}: {}.{} is {}, which is not a text", *file_, name_, key, shortened(*json));
  return json->get<std::string>();
}

std::vector<std::string> GltfObject::texts(const char* key) const {
  std::vector<std::string> result;
  const Json* json = value(key);
  if (!json) return result;
  if (!json->is_array()) fail("{}: {}.{} is not a list", *file_, name_, key);
  for (const Json& entry : *json) {
    if (!entry.is_string()) fail("{}: {}.{} is not a list of texts", *file_, name_, key);
    result.push_back(entry.get<std::string>());
  }
  return result;
}

bool GltfObject::flag(const char* key) const {
  const Json* json = value(key);
  if (json && !json->is_boolean())
    fail("{}: {}.{} is {}, which is not true or false", *file_, name_, key, shortened(*json));
  return json && json->get<bool>();
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
  if (!json->is_array()) fail("{}: {}.{} is not a list", *file_, name_, key);
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
