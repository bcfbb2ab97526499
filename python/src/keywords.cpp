// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/keywords.h"

#include <fmt/format.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>

#include "base/error.h"

namespace axial::python {
namespace {

[[noreturn]] void refuse_type(const char* name, const py::handle& value, const char* wanted) {
  throw py::type_error(
      fmt::format("{}: must be {}, not {}", name, wanted, py::repr(value).cast<std::string>()));
}

}  // namespace

Keywords& Keywords::add(const char* name, std::function<void(const py::handle&)> set) {
  set_[name] = std::move(set);
  return *this;
}

Keywords& Keywords::add_zero_or(const char* name, int& field, int low, int high) {
  return add(name, [=, &field](const py::handle& value) {
    field = static_cast<int>(number(name, value, 0, high, true));
    if (field != 0 && field < low)
      fail("{} {}: must be 0, or from {} to {}", setting(name), field, low, high);
  });
}

Keywords& Keywords::add(const char* name, bool& field) {
  return add(name, [=, &field](const py::handle& value) {
    if (!py::isinstance<py::bool_>(value)) refuse_type(name, value, "True or False");
    field = value.cast<bool>();
  });
}

Keywords& Keywords::add(const char* name, std::filesystem::path& field) {
  return add(name, [=, &field](const py::handle& value) {
    py::detail::make_caster<std::filesystem::path> path;
    if (value.is_none()) return field.clear();
    if (!path.load(value, true)) {
      PyErr_Clear();
      refuse_type(name, value, "a path");
    }
    field = py::detail::cast_op<std::filesystem::path>(path);
    if (!field.empty()) field = std::filesystem::absolute(field);
  });
}

double Keywords::number(const char* name, const py::handle& value, double low, double high,
                        bool whole) {
  const char* wanted = whole ? "a whole number" : "a number";
  const bool is_number = !py::isinstance<py::bool_>(value) &&
                         (whole ? PyIndex_Check(value.ptr()) : PyNumber_Check(value.ptr()));
  if (!is_number) refuse_type(name, value, wanted);
  const double number = PyFloat_AsDouble(value.ptr());
  if (PyErr_Occurred()) {
    PyErr_Clear();
    refuse_type(name, value, wanted);
  }
  if (!(number >= low && number <= high))
    fail("{} {}: must be from {} to {}", setting(name), number, low, high);
  return number;
}

std::string Keywords::word(const char* name, const py::handle& value,
                           const std::vector<std::string>& words) {
  const std::string given = py::str(value).cast<std::string>();
  if (std::ranges::find(words, given) == words.end())
    fail("{} '{}': must be one of {}", setting(name), given, fmt::join(words, ", "));
  return given;
}

void Keywords::take(const py::dict& values, const char* function) const {
  for (const auto& [name, value] : values) {
    const auto known = set_.find(name.cast<std::string>());
    if (known == set_.end())
      throw py::type_error(fmt::format("{}() got an unexpected keyword argument '{}'", function,
                                       name.cast<std::string>()));
    known->second(value);
  }
}

}  // namespace axial::python
