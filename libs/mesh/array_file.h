// SPDX-License-Identifier: GPL-3.0-or-later
// Files of arrays, in which a run keeps intermediate results. They are read by the program that
// wrote them, on a machine of the same kind.
#pragma once

#include <cstring>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace axial::mesh {

// The bytes of an array. T: a type without pointers and padding.
template <class T>
std::string_view bytes_of(const std::vector<T>& values) {
  static_assert(std::is_standard_layout_v<T>);
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

// The array with these bytes; the reverse of bytes_of(). Bytes behind the last whole value are
// dropped.
template <class T>
std::vector<T> array_of(std::string_view bytes) {
  static_assert(std::is_standard_layout_v<T>);
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!values.empty())
    std::memcpy(static_cast<void*>(values.data()), bytes.data(), values.size() * sizeof(T));
  return values;
}

// Writes `arrays` through a temporary file. `kind`: names the content and the version of the
// format. `made_from`: identifies the inputs and the settings. Error if the file cannot be written.
void write_arrays(const std::filesystem::path& file, const std::string& kind,
                  const std::string& made_from, std::span<const std::string_view> arrays);

// Reads the arrays back. Empty if the file does not exist, is damaged, or was written with another
// kind or made from something else, or with another number of arrays than `count`.
std::optional<std::vector<std::string>> read_arrays(const std::filesystem::path& file,
                                                    const std::string& kind,
                                                    const std::string& made_from,
                                                    std::size_t count);

}  // namespace axial::mesh
