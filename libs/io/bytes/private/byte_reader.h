// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: reads little-endian binary data with checks of the bounds. The readers of
// .mvs, .dmap, binary PLY and COLMAP's binary models use this class.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "base/error.h"
#include "bytes/private/only_for_io.h"

namespace axial::io {

static_assert(std::endian::native == std::endian::little, "the file readers assume little-endian");

// Reads values one after the other. The bytes given to the constructor must outlive the reader. If
// the bytes end too early, a reading function throws an Error that contains the names of the file
// and of the field. The caller passes the name of the field in `field`.
class ByteReader {
 public:
  ByteReader(std::string_view bytes, std::string file) : bytes_(bytes), file_(std::move(file)) {}

  const std::string& file() const { return file_; }
  std::size_t position() const { return position_; }
  std::size_t left() const { return bytes_.size() - position_; }

  // Reads and returns the next `size` bytes.
  std::string_view take(std::size_t size, std::string_view field) {
    if (size > left())
      fail_in(file_, "truncated: {} needs {} bytes at byte {}, but {} are left", field, size,
              position_, left());
    const std::string_view taken = bytes_.substr(position_, size);
    position_ += size;
    return taken;
  }

  template <class T>
  T read(std::string_view field) {
    static_assert(std::is_arithmetic_v<T>);
    T value;
    std::memcpy(&value, take(sizeof(T), field).data(), sizeof(T));
    return value;
  }

  template <class T, std::size_t N>
  void read(std::span<T, N> values, std::string_view field) {
    static_assert(std::is_arithmetic_v<T>);
    if (values.empty()) return;
    std::memcpy(values.data(), take(values.size_bytes(), field).data(), values.size_bytes());
  }

  // Reads a 64-bit count of elements, each of which takes at least `min_bytes`. Error if the bytes
  // left cannot hold so many elements. The caller can therefore allocate memory for the count.
  std::size_t count(std::size_t min_bytes, std::string_view field) {
    const auto number = read<std::uint64_t>(field);
    require_room(number, min_bytes, field);
    return static_cast<std::size_t>(number);
  }

  void require_room(std::uint64_t number, std::uint64_t min_bytes, std::string_view field) const {
    if (number > left() / min_bytes)
      fail_in(file_,
              "{} should have {} elements, but only {} bytes are left (truncated or malformed)",
              field, number, left());
  }

  // Reads a 64-bit length, then that many bytes.
  std::string string(std::string_view field) {
    const std::size_t size = count(1, field);
    return std::string(take(size, field));
  }

  // Reads bytes up to a NUL and skips the NUL.
  std::string c_string(std::string_view field) {
    const std::size_t end = bytes_.find('\0', position_);
    if (end == std::string_view::npos)
      fail_in(file_, "truncated: {} at byte {} has no end", field, position_);
    std::string text(bytes_.substr(position_, end - position_));
    position_ = end + 1;
    return text;
  }

  // Error unless all bytes have been read.
  void require_end() const {
    if (left() > 0) fail_in(file_, "malformed: {} bytes follow the end of the data", left());
  }

 private:
  std::string_view bytes_;
  std::string file_;
  std::size_t position_ = 0;
};

}  // namespace axial::io
