// SPDX-License-Identifier: GPL-3.0-or-later
#include "private/ply/ply_header.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "private/bytes/text_reader.h"

namespace axial::io {
namespace {

std::optional<PlyType> type_named(std::string_view name) {
  static constexpr std::array<std::pair<std::string_view, PlyType>, 16> kNames{{
      {"char", PlyType::kInt8},
      {"int8", PlyType::kInt8},  //
      {"uchar", PlyType::kUint8},
      {"uint8", PlyType::kUint8},  //
      {"short", PlyType::kInt16},
      {"int16", PlyType::kInt16},  //
      {"ushort", PlyType::kUint16},
      {"uint16", PlyType::kUint16},  //
      {"int", PlyType::kInt32},
      {"int32", PlyType::kInt32},  //
      {"uint", PlyType::kUint32},
      {"uint32", PlyType::kUint32},  //
      {"float", PlyType::kFloat32},
      {"float32", PlyType::kFloat32},  //
      {"double", PlyType::kFloat64},
      {"float64", PlyType::kFloat64},
  }};
  for (const auto& [known, type] : kNames)
    if (known == name) return type;
  return {};
}

PlyType parse_type(TextLine& line, std::string_view field) {
  const std::string_view name = line.word(field);
  const auto type = type_named(name);
  if (!type) fail("{}: {} is '{}', which is not a PLY type", line.where(), field, name);
  return *type;
}

bool is_float(PlyType type) {
  return type == PlyType::kFloat32 || type == PlyType::kFloat64;
}

PlyFormat parse_format(TextLine& line) {
  const std::string_view name = line.word("format");
  const std::string_view version = line.word("format version");
  if (version != "1.0") fail("{}: PLY version is '{}', expected 1.0", line.where(), version);
  if (name == "ascii") return PlyFormat::kAscii;
  if (name == "binary_little_endian") return PlyFormat::kLittleEndian;
  if (name == "binary_big_endian") return PlyFormat::kBigEndian;
  fail("{}: format is '{}', which is not a PLY format", line.where(), name);
}

void parse_property(TextLine& line, std::vector<PlyElement>& elements) {
  if (elements.empty()) fail("{}: property before any element", line.where());
  PlyProperty property;
  const TextLine start = line;
  property.is_list = line.word("property type") == "list";
  if (property.is_list) {
    property.count_type = parse_type(line, "list count type");
    if (is_float(property.count_type)) fail("{}: list counted in a float type", line.where());
  } else {
    line = start;
  }
  property.type = parse_type(line, "property type");
  property.name = line.word("property name");
  auto& properties = elements.back().properties;
  for (const PlyProperty& other : properties)
    if (other.name == property.name)
      fail("{}: property {} is declared twice", line.where(), property.name);
  properties.push_back(std::move(property));
}

// Reads the comments "geo_offset X Y Z" and "TextureFile NAME", and ignores others.
void parse_comment(TextLine line, PlyHeader& header) {
  if (line.empty()) return;
  const std::string_view kind = line.word("comment");
  if (kind == "TextureFile") header.texture_files.emplace_back(line.file_name());
  if (kind != "geo_offset") return;
  if (header.geo_offset) fail("{}: second geo_offset", line.where());
  Eigen::Vector3d& offset = header.geo_offset.emplace();
  for (double& coordinate : offset) coordinate = line.number<double>("geo_offset");
  if (!line.rest().empty()) fail("{}: unexpected '{}'", line.where(), line.rest());
}

// The smallest number of bytes of one row.
std::uint64_t min_row_bytes(const PlyElement& element, PlyFormat format) {
  std::uint64_t bytes = 0;
  for (const PlyProperty& p : element.properties)
    bytes += format == PlyFormat::kAscii ? 2 : ply_size(p.is_list ? p.count_type : p.type);
  return bytes;
}

}  // namespace

std::size_t ply_size(PlyType type) {
  switch (type) {
    case PlyType::kInt8:
    case PlyType::kUint8:
      return 1;
    case PlyType::kInt16:
    case PlyType::kUint16:
      return 2;
    case PlyType::kInt32:
    case PlyType::kUint32:
    case PlyType::kFloat32:
      return 4;
    case PlyType::kFloat64:
      return 8;
  }
  return 8;
}

PlyHeader parse_ply_header(std::string_view bytes, const std::string& file) {
  const std::string_view text = without_byte_order_mark(bytes);
  if (!text.starts_with("ply\n") && !text.starts_with("ply\r\n"))
    fail("{}: is not a PLY file (does not start with 'ply')", file);
  TextReader reader(bytes, file);
  PlyHeader header;
  bool has_format = false;
  reader.line();
  while (std::optional<TextLine> line = reader.line()) {
    const std::string_view keyword = line->word("header keyword");
    if (keyword == "comment") parse_comment(*line, header);
    if (keyword == "comment" || keyword == "obj_info") continue;
    if (keyword == "format") {
      if (has_format) fail("{}: second format line", line->where());
      header.format = parse_format(*line);
      has_format = true;
    } else if (keyword == "element") {
      PlyElement element;
      element.name = line->word("element name");
      element.count = line->number<std::uint64_t>("element count");
      header.elements.push_back(std::move(element));
    } else if (keyword == "property") {
      parse_property(*line, header.elements);
    } else if (keyword != "end_header") {
      fail("{}: '{}' is not a PLY header keyword", line->where(), keyword);
    }
    if (!line->rest().empty()) fail("{}: unexpected '{}'", line->where(), line->rest());
    if (keyword == "end_header") {
      if (!has_format) fail("{}: the PLY header has no format line", file);
      header.body = reader.position();
      return header;
    }
  }
  fail("{}: truncated: the PLY header has no end_header", file);
}

PlyBody::PlyBody(std::string_view bytes, const std::string& file, const PlyHeader& header)
    : reader_(bytes.substr(header.body), file),
      format_(header.format),
      text_(bytes.substr(header.body)) {
  // Without the final newline, a truncated last number could not be recognised.
  if (format_ == PlyFormat::kAscii && !text_.empty() && text_.back() != '\n')
    fail("{}: truncated: the last line has no end", file);
}

void require_rows(const PlyElement& element, PlyFormat format, std::uint64_t left,
                  const std::string& file) {
  const std::uint64_t row = min_row_bytes(element, format);
  if (row == 0 && element.count > 0)
    fail("{}: element {} has {} rows without properties", file, element.name, element.count);
  if (row > 0 && element.count > left / row)
    fail("{}: truncated: element {} should have {} rows, but only {} bytes are left", file,
         element.name, element.count, left);
}

void PlyBody::require_rows(const PlyElement& element) const {
  io::require_rows(element, format_, left(), reader_.file());
}

template <class T>
T PlyBody::binary(const std::string& name) {
  if (format_ == PlyFormat::kLittleEndian) return reader_.read<T>(name);
  std::array<char, sizeof(T)> bytes;
  const std::string_view taken = reader_.take(sizeof(T), name);
  std::reverse_copy(taken.begin(), taken.end(), bytes.begin());
  return std::bit_cast<T>(bytes);
}

double PlyBody::ascii(PlyType type, const std::string& name) {
  const std::string_view token = take_token(text_);
  if (token.empty()) fail("{}: truncated: no more values at {}", reader_.file(), name);
  static constexpr std::array<std::pair<double, double>, 6> kRanges{{{-128.0, 127.0},
                                                                     {0.0, 255.0},
                                                                     {-32768.0, 32767.0},
                                                                     {0.0, 65535.0},
                                                                     {-2147483648.0, 2147483647.0},
                                                                     {0.0, 4294967295.0}}};
  const std::optional<double> parsed = parse_number<double>(token);
  const double value = parsed.value_or(0);
  bool good = parsed.has_value();
  if (good && !is_float(type)) {
    const auto [lowest, highest] = kRanges[static_cast<std::size_t>(type)];
    good = value >= lowest && value <= highest && value == std::trunc(value);
  }
  if (!good) fail("{}: {} is '{}', which is not a value of its type", reader_.file(), name, token);
  return value;
}

double PlyBody::scalar(PlyType type, const std::string& name) {
  if (format_ == PlyFormat::kAscii) return ascii(type, name);
  switch (type) {
    case PlyType::kInt8:
      return binary<std::int8_t>(name);
    case PlyType::kUint8:
      return binary<std::uint8_t>(name);
    case PlyType::kInt16:
      return binary<std::int16_t>(name);
    case PlyType::kUint16:
      return binary<std::uint16_t>(name);
    case PlyType::kInt32:
      return binary<std::int32_t>(name);
    case PlyType::kUint32:
      return binary<std::uint32_t>(name);
    case PlyType::kFloat32:
      return static_cast<double>(binary<float>(name));
    case PlyType::kFloat64:
      return binary<double>(name);
  }
  fail("{}: {} has no type", reader_.file(), name);
}

std::size_t PlyBody::list_size(const PlyProperty& property) {
  const double size = scalar(property.count_type, property.name);
  const std::size_t left =
      format_ == PlyFormat::kAscii ? text_.size() / 2 : reader_.left() / ply_size(property.type);
  if (size < 0 || size > static_cast<double>(left))
    fail("{}: list {} should have {} values, which the file cannot contain", reader_.file(),
         property.name, size);
  return static_cast<std::size_t>(size);
}

void PlyBody::require_end() const {
  const bool more = format_ == PlyFormat::kAscii ? !trimmed(text_).empty() : reader_.left() > 0;
  if (more) fail("{}: malformed: data follow the last element", reader_.file());
}

}  // namespace axial::io
