// SPDX-License-Identifier: GPL-3.0-or-later
// Checked reading of objects in JSON files.
#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "io/bytes/json.h"

namespace axial::io {

inline bool is_finite_number(const nlohmann::json& value) {
  return value.is_number() && std::isfinite(value.get<double>());
}

// An object of the file and its place, for messages.
struct Entry {
  const nlohmann::json& object;
  std::string where;

  const nlohmann::json* find(const char* key) const {
    const auto found = object.find(key);
    return found == object.end() || found->is_null() ? nullptr : &*found;
  }
  bool has(const char* key) const { return find(key) != nullptr; }
  [[noreturn]] void refuse(const char* key, const char* expected) const {
    const auto found = object.find(key);
    fail("{}.{} is {}, but must be {}", where, key,
         found == object.end() ? "missing" : to_text(*found), expected);
  }
  double number(const char* key) const {
    const nlohmann::json* value = find(key);
    if (!value || !is_finite_number(*value)) refuse(key, "a finite number");
    return value->get<double>();
  }
  double number_or(const char* key, double otherwise) const {
    return has(key) ? number(key) : otherwise;
  }
  std::string text(const char* key) const {
    const nlohmann::json* value = find(key);
    if (!value || !value->is_string() || value->get_ref<const std::string&>().empty())
      refuse(key, "a text");
    return value->get<std::string>();
  }
  bool flag(const char* key) const {
    const nlohmann::json* value = find(key);
    if (value && !value->is_boolean()) refuse(key, "true or false");
    return value && value->get<bool>();
  }
  // The numbers of a list of this length.
  std::vector<double> numbers(const char* key, std::size_t count, const char* expected) const {
    const nlohmann::json* value = find(key);
    if (!value || !value->is_array() || value->size() != count) refuse(key, expected);
    std::vector<double> result;
    for (const nlohmann::json& item : *value) {
      if (!is_finite_number(item)) refuse(key, expected);
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
void for_each_entry(const nlohmann::json& file, const std::string& name, const char* key, Use use) {
  const auto found = file.find(key);
  if (found == file.end()) return;
  if (!found->is_array()) fail_in(name, "{} must be a list", key);
  for (std::size_t i = 0; i < found->size(); ++i) {
    const Entry entry{(*found)[i], fmt::format("{}: {}[{}]", name, key, i)};
    if (!entry.object.is_object()) fail("{} must be an object", entry.where);
    use(entry);
  }
}

}  // namespace axial::io
