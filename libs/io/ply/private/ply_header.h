// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: the PLY header, and the values that follow it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bytes/private/byte_reader.h"
#include "bytes/private/only_for_io.h"

namespace axial::io {

enum class PlyFormat { kAscii, kLittleEndian, kBigEndian };
enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

// Calls `call` with a zero of the C++ type of `type`, and returns its result.
template <class Call>
auto with_ply_type(PlyType type, Call call) {
  switch (type) {
    case PlyType::kInt8:
      return call(std::int8_t{});
    case PlyType::kUint8:
      return call(std::uint8_t{});
    case PlyType::kInt16:
      return call(std::int16_t{});
    case PlyType::kUint16:
      return call(std::uint16_t{});
    case PlyType::kInt32:
      return call(std::int32_t{});
    case PlyType::kUint32:
      return call(std::uint32_t{});
    case PlyType::kFloat32:
      return call(float{});
    case PlyType::kFloat64:
      break;
  }
  return call(double{});
}

inline std::size_t ply_size(PlyType type) {
  return with_ply_type(type, [](auto zero) { return sizeof zero; });
}

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::kFloat32;
  bool is_list = false;
  PlyType count_type = PlyType::kUint8;  // type of a list's length
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::kAscii;
  std::vector<PlyElement> elements;
  std::optional<Eigen::Vector3d> geo_offset;  // from "comment geo_offset X Y Z"
  std::vector<std::string> texture_files;     // from "comment TextureFile NAME"
  std::size_t body = 0;                       // offset of the data in the file [bytes]
};

// Parses the header. Error that names `file` if it is not well-formed.
PlyHeader parse_ply_header(std::string_view bytes, const std::string& file);

// Error that names `file` if `left` bytes cannot hold the declared rows of `element`. Call this
// function before memory is allocated for `element.count` rows: the count of a damaged file may be
// huge.
void require_rows(const PlyElement& element, PlyFormat format, std::uint64_t left,
                  const std::string& file);

// Reads the values of the body, in any of the three formats. Values are returned as double, because
// a double holds the values of all PLY types exactly.
class PlyBody {
 public:
  PlyBody(std::string_view bytes, const std::string& file, const PlyHeader& header);

  // The function require_rows() above, for the bytes left.
  void require_rows(const PlyElement& element) const;

  // The number of bytes that have not been read.
  std::size_t left() const { return format_ == PlyFormat::kAscii ? text_.size() : reader_.left(); }

  // Reads one value. Error if the bytes end or a value does not fit its type. Infinite and NaN
  // values are returned.
  double scalar(PlyType type, const std::string& name);

  // Reads the length of a list. The caller must read the values of the list next. Error if the
  // bytes left cannot hold these values.
  std::size_t list_size(const PlyProperty& property);

  // Error if data follow the last element.
  void require_end() const;

 private:
  template <class T>
  T binary(const std::string& name);
  double ascii(PlyType type, const std::string& name);

  ByteReader reader_;
  PlyFormat format_;
  std::string_view text_;  // the rest of an ascii body
};

}  // namespace axial::io
