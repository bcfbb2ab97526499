// SPDX-License-Identifier: GPL-3.0-or-later
#include "ply/private/ply_header.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "bytes/private/text_reader.h"

namespace axial::io {
namespace {

// The names of each PlyType.
constexpr std::array<std::array<std::string_view, 2>, 8> kTypes{{{"char", "int8"},
                                                                 {"uchar", "uint8"},
                                                                 {"short", "int16"},
                                                                 {"ushort", "uint16"},
                                                                 {"int", "int32"},
                                                                 {"uint", "uint32"},
                                                                 {"float", "float32"},
                                                                 {"double", "float64"}}};

PlyType parse_type(TextLine& line, std::string_view field) {
  const std::string_view name = line.word(field);
  const auto type = std::ranges::find_if(
      kTypes, [&](const auto& names) { return names[0] == name || names[1] == name; });
  if (type == kTypes.end())
    fail_in(line.where(), "{} is '{}', which is not a PLY type", field, name);
  return static_cast<PlyType>(type - kTypes.begin());
}

bool is_float(PlyType type) {
  return type == PlyType::kFloat32 || type == PlyType::kFloat64;
}

PlyFormat parse_format(TextLine& line) {
  const std::string_view name = line.word("format");
  const std::string_view version = line.word("format version");
  if (version != "1.0") fail_in(line.where(), "PLY version is '{}', expected 1.0", version);
  if (name == "ascii") return PlyFormat::kAscii;
  if (name == "binary_little_endian") return PlyFormat::kLittleEndian;
  if (name == "binary_big_endian") return PlyFormat::kBigEndian;
  fail_in(line.where(), "format is '{}', which is not a PLY format", name);
}

void parse_property(TextLine& line, std::vector<PlyElement>& elements) {
  if (elements.empty()) fail_in(line.where(), "property before any element");
  PlyProperty property;
  const TextLine start = line;
  property.is_list = line.word("property type") == "list";
  if (property.is_list) {
    property.count_type = parse_type(line, "list count type");
    if (is_float(property.count_type)) fail_in(line.where(), "list counted in a float type");
  } else {
    line = start;
  }
  property.type = parse_type(line, "property type");
  property.name = line.word("property name");
  auto& properties = elements.back().properties;
  for (const PlyProperty& other : properties)
    if (other.name == property.name)
      fail_in(line.where(), "property {} is declared twice", property.name);
  properties.push_back(std::move(property));
}

// Reads the comments "geo_offset X Y Z" and "TextureFile NAME", and ignores others.
void parse_comment(TextLine line, PlyHeader& header) {
  if (line.empty()) return;
  const std::string_view kind = line.word("comment");
  if (kind == "TextureFile") header.texture_files.emplace_back(line.file_name());
  if (kind != "geo_offset") return;
  if (header.geo_offset) fail_in(line.where(), "second geo_offset");
  Eigen::Vector3d& offset = header.geo_offset.emplace();
  for (double& coordinate : offset) coordinate = line.number<double>("geo_offset");
  if (!line.rest().empty()) fail_in(line.where(), "unexpected '{}'", line.rest());
}

// The smallest number of bytes of one row.
std::uint64_t min_row_bytes(const PlyElement& element, PlyFormat format) {
  std::uint64_t bytes = 0;
  for (const PlyProperty& p : element.properties)
    bytes += format == PlyFormat::kAscii ? 2 : ply_size(p.is_list ? p.count_type : p.type);
  return bytes;
}

}  // namespace

PlyHeader parse_ply_header(std::string_view bytes, const std::string& file) {
  const std::string_view text = without_byte_order_mark(bytes);
  if (!text.starts_with("ply\n") && !text.starts_with("ply\r\n"))
    fail_in(file, "is not a PLY file (does not start with 'ply')");
  TextReader reader(bytes, file);
  PlyHeader header;
  bool has_format = false;
  reader.line();
  while (std::optional<TextLine> line = reader.line()) {
    const std::string_view keyword = line->word("header keyword");
    if (keyword == "comment") parse_comment(*line, header);
    if (keyword == "comment" || keyword == "obj_info") continue;
    if (keyword == "format") {
      if (has_format) fail_in(line->where(), "second format line");
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
      fail_in(line->where(), "'{}' is not a PLY header keyword", keyword);
    }
    if (!line->rest().empty()) fail_in(line->where(), "unexpected '{}'", line->rest());
    if (keyword == "end_header") {
      if (!has_format) fail_in(file, "the PLY header has no format line");
      header.body = reader.position();
      return header;
    }
  }
  fail_in(file, "truncated: the PLY header has no end_header");
}

PlyBody::PlyBody(std::string_view bytes, const std::string& file, const PlyHeader& header)
    : reader_(bytes.substr(header.body), file),
      format_(header.format),
      text_(bytes.substr(header.body)) {
  // Without the final newline, a truncated last number could not be recognised.
  if (format_ == PlyFormat::kAscii && !text_.empty() && text_.back() != '\n')
    fail_in(file, "truncated: the last line has no end");
}

void require_rows(const PlyElement& element, PlyFormat format, std::uint64_t left,
                  const std::string& file) {
  const std::uint64_t row = min_row_bytes(element, format);
  if (row == 0 && element.count > 0)
    fail_in(file, "element {} has {} rows without properties", element.name, element.count);
  if (row > 0 && element.count > left / row)
    fail_in(file, "truncated: element {} should have {} rows, but only {} bytes are left",
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
  if (token.empty()) fail_in(reader_.file(), "truncated: no more values at {}", name);
  const std::optional<double> parsed = parse_number<double>(token);
  const double value = parsed.value_or(0);
  const bool good =
      parsed && with_ply_type(type, [&](auto zero) {
        using Limits = std::numeric_limits<decltype(zero)>;
        return !Limits::is_integer ||
               (value >= static_cast<double>(Limits::lowest()) &&
                value <= static_cast<double>(Limits::max()) && value == std::trunc(value));
      });
  if (!good) fail_in(reader_.file(), "{} is '{}', which is not a value of its type", name, token);
  return value;
}

double PlyBody::scalar(PlyType type, const std::string& name) {
  if (format_ == PlyFormat::kAscii) return ascii(type, name);
  return with_ply_type(
      type, [&](auto zero) { return static_cast<double>(binary<decltype(zero)>(name)); });
}

std::size_t PlyBody::list_size(const PlyProperty& property) {
  const double size = scalar(property.count_type, property.name);
  const std::size_t left =
      format_ == PlyFormat::kAscii ? text_.size() / 2 : reader_.left() / ply_size(property.type);
  if (size < 0 || size > static_cast<double>(left))
    fail_in(reader_.file(), "list {} should have {} values, which the file cannot contain",
            property.name, size);
  return static_cast<std::size_t>(size);
}

void PlyBody::require_end() const {
  const bool more = format_ == PlyFormat::kAscii ? !trimmed(text_).empty() : reader_.left() > 0;
  if (more) fail_in(reader_.file(), "malformed: data follow the last element");
}

}  // namespace axial::io
