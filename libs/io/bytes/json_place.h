// SPDX-License-Identifier: GPL-3.0-or-later
// Checked reading of the values in a JSON file.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace axial::io {

// A value and its place in the file. Functions that read give an Error "PLACE is VALUE, expected
// ..." for a value of another type, and "PLACE is missing" for a key that an object lacks.
struct JsonPlace {
  const nlohmann::json& json;  // lives longer than the JsonPlace
  std::string where;           // such as "FILE: housing.ports.main"; of a whole file: "FILE:"

  // The content of a file.
  static JsonPlace of_file(const nlohmann::json& content, const std::filesystem::path& file);

  // Throws the Error about a value that is not the `expected` one, such as "three numbers".
  [[noreturn]] void refuse(const std::string& expected) const;

  double number() const;         // finite
  double number_from_0() const;  // finite and at least 0
  std::string text() const;
  std::string name() const;  // a text that is not empty
  bool flag() const;
  std::vector<double> numbers(std::size_t count) const;  // a list of `count` finite numbers
  Eigen::Vector3d vector() const;                        // a list of three finite numbers
  std::vector<JsonPlace> elements() const;               // of a list
  std::vector<std::string> keys() const;                 // of an object

  bool has(const char* key) const;        // whether this is an object with the key
  bool has_value(const char* key) const;  // has(), and the value is not null
  JsonPlace at(const std::string& key) const;
  double number(const char* key) const { return at(key).number(); }
  std::string text(const char* key) const { return at(key).text(); }
  std::string name(const char* key) const { return at(key).name(); }
  bool flag(const char* key) const { return at(key).flag(); }
  std::vector<JsonPlace> elements(const char* key) const { return at(key).elements(); }

  // The same, if has_value().
  double number_or(const char* key, double otherwise) const;
  bool flag_or_false(const char* key) const;
  std::vector<JsonPlace> elements_or_none(const char* key) const;

  // Error unless this is an object whose keys are all among `known`.
  void require_object(std::initializer_list<std::string_view> known) const;
  void require_version_1() const;  // Error unless the key "version" is 1
};

// Whether the value is a number, and finite.
bool is_finite_number(const nlohmann::json& value);

}  // namespace axial::io
