// SPDX-License-Identifier: GPL-3.0-or-later
// Files of arrays, in which a run keeps intermediate results. They are read by the program that
// wrote them, on a machine of the same kind. The elements are types without pointers and padding.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <span>
#include <type_traits>
#include <vector>

#include "base/hash.h"
#include "io/artifacts/artifact.h"

namespace axial::io {

// write_arrays() of bytes.
void write_byte_arrays(const Artifact& artifact,
                       std::span<const std::span<const std::byte>> arrays);

// Reads the arrays of a file one after the other, for read_arrays().
class ArrayReader {
 public:
  ArrayReader(const Artifact& artifact, std::size_t count);

  // False if the file does not have such an array.
  template <class T>
  bool read(std::vector<T>& values) {
    static_assert(std::is_standard_layout_v<T>);
    const std::uint64_t bytes = next_size();
    if (!in_ || bytes % sizeof(T) != 0) return false;
    values.resize(bytes / sizeof(T));
    return read_bytes(std::as_writable_bytes(std::span(values)));
  }
  // Whether the file ends, and has the bytes that were written.
  bool is_whole();

 private:
  std::string next_print();
  std::uint64_t next_size();
  bool read_bytes(std::span<std::byte> bytes);

  std::ifstream in_;  // fails if the file is not the artifact
  std::uint64_t size_ = 0;
  Fingerprint print_;
};

// Writes `arrays` through a temporary file. Error if the file cannot be written.
template <class... T>
void write_arrays(const Artifact& artifact, const std::vector<T>&... arrays) {
  write_byte_arrays(artifact, std::array{std::as_bytes(std::span(arrays))...});
}

// Reads the arrays back, and returns true. Returns false if the file does not exist, is damaged,
// was made from something else, or has another kind or another number of arrays: the arrays may
// have any content then.
template <class... T>
bool read_arrays(const Artifact& artifact, std::vector<T>&... arrays) {
  ArrayReader reader(artifact, sizeof...(T));
  return (reader.read(arrays) && ...) && reader.is_whole();
}

}  // namespace axial::io
