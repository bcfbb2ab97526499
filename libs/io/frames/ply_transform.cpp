// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/frames/ply_transform.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/atomic_file.h"
#include "base/error.h"
#include "bytes/private/byte_writer.h"
#include "io/frames/lost_offset.h"
#include "io/ply/ply.h"
#include "ply/private/ply_header.h"

namespace axial::io {
namespace {

constexpr std::size_t kAbsent = static_cast<std::size_t>(-1);
using Columns = std::array<std::size_t, 3>;

// The places of three properties that are floats; absent if one of them is.
Columns columns_of(const PlyElement& element, const std::array<const char*, 3>& names) {
  Columns columns{kAbsent, kAbsent, kAbsent};
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      const bool is_float =
          property.type == PlyType::kFloat32 || property.type == PlyType::kFloat64;
      if (property.name == names[k] && !property.is_list && is_float) columns[k] = i;
    }
  if (std::ranges::find(columns, kAbsent) != columns.end()) return {kAbsent, kAbsent, kAbsent};
  return columns;
}

// What happens to the vertices of one file.
struct Vertices {
  const PlyElement* element = nullptr;
  Columns position, normal, error;  // only the first column of `error` is used
  Similarity similarity;            // from the stored positions to the written ones
};

void write_value(ByteWriter& out, PlyType type, double value) {
  with_ply_type(type, [&](auto zero) { out.write(static_cast<decltype(zero)>(value)); });
}

// One row: the values of every property, one for a scalar.
using Row = std::vector<std::vector<double>>;

void read_row(PlyBody& body, const PlyElement& element, Row& row) {
  row.resize(element.properties.size());
  for (std::size_t i = 0; i < row.size(); ++i) {
    const PlyProperty& property = element.properties[i];
    row[i].resize(property.is_list ? body.list_size(property) : 1);
    for (double& value : row[i]) value = body.scalar(property.type, property.name);
  }
}

void write_row(ByteWriter& out, const PlyElement& element, const Row& row) {
  for (std::size_t i = 0; i < row.size(); ++i) {
    const PlyProperty& property = element.properties[i];
    if (property.is_list) write_value(out, property.count_type, static_cast<double>(row[i].size()));
    for (const double value : row[i]) write_value(out, property.type, value);
  }
}

void set(Row& row, const Columns& columns, const Eigen::Vector3d& vector) {
  for (std::size_t k = 0; k < 3; ++k) row[columns[k]][0] = vector(static_cast<Eigen::Index>(k));
}

Eigen::Vector3d get(const Row& row, const Columns& columns) {
  return {row[columns[0]][0], row[columns[1]][0], row[columns[2]][0]};
}

void move_vertex(const Vertices& vertices, std::uint64_t index, const std::string& file, Row& row) {
  const Eigen::Vector3d x = vertices.similarity(get(row, vertices.position));
  const bool is_float =
      vertices.element->properties[vertices.position[0]].type == PlyType::kFloat32;
  if (!x.allFinite() || (is_float && !x.cast<float>().allFinite()))
    fail_in(file, "vertex {} has no finite position after the transformation", index);
  set(row, vertices.position, x);
  if (vertices.normal[0] != kAbsent)
    set(row, vertices.normal, vertices.similarity.rotation * get(row, vertices.normal));
  if (vertices.error[0] != kAbsent) row[vertices.error[0]][0] *= vertices.similarity.scale;
}

// Error if one of the corners of a face, a list in `row`, is not one of the `vertices` vertices.
void check_corners(const PlyElement& face, const Row& row, std::uint64_t vertices,
                   const std::string& file) {
  for (std::size_t i = 0; i < row.size(); ++i) {
    const PlyProperty& property = face.properties[i];
    if (!property.is_list || (property.name != "vertex_indices" && property.name != "vertex_index"))
      continue;
    for (const double corner : row[i])
      if (!(corner >= 0 && corner < static_cast<double>(vertices)))
        fail_in(file, "a face refers to vertex {}, but there are {}", corner, vertices);
  }
}

// The lines of the header, with another format and another origin.
std::string new_header(std::string_view text, const std::string& geo) {
  std::string header = "ply\nformat binary_little_endian 1.0\n" + geo;
  text.remove_prefix(text.find('\n') + 1);  // the first line is "ply"
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.starts_with("format") || line.starts_with("comment geo_offset")) continue;
    header += std::string(line) + "\n";
  }
  return header;
}

Vertices vertices_of(const PlyHeader& header, const std::string& file) {
  const auto found = std::ranges::find(header.elements, "vertex", &PlyElement::name);
  if (found == header.elements.end() || found->count == 0) fail_in(file, "has no vertices");
  Vertices vertices;
  vertices.element = &*found;
  vertices.position = columns_of(*found, {"x", "y", "z"});
  if (vertices.position[0] == kAbsent) fail_in(file, "its vertices have no float x, y and z");
  vertices.normal = columns_of(*found, {"nx", "ny", "nz"});
  vertices.error = columns_of(*found, {"error", "error", "error"});
  return vertices;
}

}  // namespace

void transform_ply(const std::filesystem::path& input, const std::filesystem::path& output,
                   const FrameMove& move) {
  const std::string file = input.string(), bytes = read_file(input);
  const PlyHeader header = parse_ply_header(bytes, file);
  Vertices vertices = vertices_of(header, file);
  const LocalFrame stored = frame_of_positions(move.from, input);
  const bool world = !header.geo_offset && stored.is_world() &&
                     vertices.element->properties[vertices.position[0]].type == PlyType::kFloat64;
  vertices.similarity = move.ending_in(world ? LocalFrame{} : move.to).similarity;
  vertices.similarity.translation = vertices.similarity(stored.origin - move.from.origin);
  ByteWriter out;
  out.text(
      new_header(std::string_view(bytes).substr(0, header.body), geo_comment({move.to, world})));
  PlyBody body(bytes, file, header);
  Row row;
  for (const PlyElement& element : header.elements) {
    body.require_rows(element);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      read_row(body, element, row);
      if (&element == vertices.element) move_vertex(vertices, i, file, row);
      if (element.name == "face") check_corners(element, row, vertices.element->count, file);
      write_row(out, element, row);
    }
  }
  body.require_end();
  write_atomically(output, out.bytes());
}

}  // namespace axial::io
