// SPDX-License-Identifier: GPL-3.0-or-later
// Fields of JSON files that the user gives. Errors name the file and the field.
#pragma once

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/error.h"
#include "io/bytes/json.h"

namespace axial::apps {

// A value in a file.
struct JsonField {
  std::filesystem::path file;
  std::string name;  // such as "steps[2].seconds"; empty: the whole file
  nlohmann::json value;

  [[noreturn]] void refuse(const std::string& wanted) const {
    std::string found = io::to_text(value);
    if (found.size() > 60) found = found.substr(0, 60) + "...";
    fail_in(file, "{} {}: must be {}", name.empty() ? "the content" : name, found, wanted);
  }

  // The field `key` of an object.
  JsonField at(const std::string& key) const {
    if (!value.is_object()) refuse("an object");
    const std::string inner = name.empty() ? key : name + "." + key;
    if (!value.contains(key)) fail_in(file, "{} is missing", inner);
    return {file, inner, value[key]};
  }

  double number() const {
    if (!value.is_number() || !std::isfinite(value.get<double>())) refuse("a number");
    return value.get<double>();
  }

  double number_from_0() const {
    if (number() < 0) refuse("at least 0");
    return number();
  }

  std::string text() const {
    if (!value.is_string()) refuse("a text");
    return value.get<std::string>();
  }

  // The elements of a list.
  std::vector<JsonField> elements() const {
    if (!value.is_array()) refuse("a list");
    std::vector<JsonField> all;
    for (const nlohmann::json& element : value)
      all.push_back({file, name + "[" + std::to_string(all.size()) + "]", element});
    return all;
  }
};

}  // namespace axial::apps
