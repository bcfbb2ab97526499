// SPDX-License-Identifier: GPL-3.0-or-later
// Keyword arguments of a stage. Each has the name of the field of an options struct that it sets.
#pragma once

#include <pybind11/pybind11.h>

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

namespace axial::python {

namespace py = pybind11;

// The keywords of one call. Fields must exist as long as the object.
class Keywords {
 public:
  // The number must be from `low` to `high`. take() throws an Error that names the setting `name`
  // if it is not, and a TypeError for a value that is no number, or no whole number for a field of
  // whole numbers.
  template <class T>
  Keywords& add(const char* name, T& field, double low, double high) {
    return add(name, [=, &field](const py::handle& value) {
      field = static_cast<T>(number(name, value, low, high, std::is_integral_v<T>));
    });
  }
  // The same, but 0 is possible, too.
  Keywords& add_zero_or(const char* name, int& field, int low, int high);
  Keywords& add(const char* name, bool& field);
  Keywords& add(const char* name, std::filesystem::path& field);  // becomes absolute; None: empty

  // `words`: the values of Python for those of the field. Error for another value.
  template <class T>
  Keywords& add(const char* name, T& field, const std::map<std::string, T>& words) {
    std::vector<std::string> names;
    for (const auto& [word, value] : words) names.push_back(word);
    return add(
        name, [=, &field](const py::handle& value) { field = words.at(word(name, value, names)); });
  }

  Keywords& add(const char* name, std::function<void(const py::handle&)> set);

  // Sets the fields. Throws a TypeError that names a keyword of `values` which is none of these.
  void take(const py::dict& values, const char* function) const;

 private:
  static double number(const char* name, const py::handle& value, double low, double high,
                       bool whole);
  static std::string word(const char* name, const py::handle& value,
                          const std::vector<std::string>& words);

  std::map<std::string, std::function<void(const py::handle&)>> set_;
};

}  // namespace axial::python
