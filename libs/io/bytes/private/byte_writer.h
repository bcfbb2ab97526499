// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: makes little-endian binary data that ByteReader can read.
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "bytes/private/only_for_io.h"

namespace axial::io {

static_assert(std::endian::native == std::endian::little, "the file writers assume little-endian");

class ByteWriter {
 public:
  const std::string& bytes() const { return bytes_; }

  // Moves the bytes out, so that large contents are not copied.
  std::string take() { return std::move(bytes_); }

  // Removes the bytes, and keeps their room for others.
  void clear() { bytes_.clear(); }

  // Allocates room for `bytes` bytes. More bytes can be written, at the cost of a copy.
  void reserve(std::size_t bytes) { bytes_.reserve(bytes); }

  template <class T>
  void write(const T& value) {
    static_assert(std::is_arithmetic_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(T));
  }

  template <class T, std::size_t N>
  void write(std::span<T, N> values) {
    static_assert(std::is_arithmetic_v<std::remove_const_t<T>>);
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  }

  void count(std::size_t number) { write<std::uint64_t>(number); }

  void text(std::string_view characters) { bytes_.append(characters); }

  // Writes a 64-bit length, then the bytes.
  void string(std::string_view characters) {
    count(characters.size());
    text(characters);
  }

 private:
  std::string bytes_;
};

}  // namespace axial::io
