// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/ply/ply_property.h"

#include <algorithm>

#include "base/atomic_file.h"
#include "base/error.h"
#include "private/ply/ply_header.h"

namespace axial::io {
namespace {

// Calls take(index, value) for every scalar property of a row; lists are skipped.
template <class Take>
void read_row(PlyBody& body, const PlyElement& element, Take take) {
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    const PlyProperty& property = element.properties[i];
    const std::size_t values = property.is_list ? body.list_size(property) : 1;
    for (std::size_t k = 0; k < values; ++k) {
      const double value = body.scalar(property.type, property.name);
      if (!property.is_list) take(i, value);
    }
  }
}

}  // namespace

std::vector<float> read_vertex_property(const std::filesystem::path& path,
                                        const std::string& name) {
  const std::string file = path.string(), bytes = read_file(path);
  const PlyHeader header = parse_ply_header(bytes, file);
  PlyBody body(bytes, file, header);
  std::vector<float> values;
  for (const PlyElement& element : header.elements) {
    const bool vertices = element.name == "vertex";
    const auto found = std::ranges::find_if(element.properties, [&](const PlyProperty& property) {
      return vertices && property.name == name && !property.is_list;
    });
    if (vertices && found == element.properties.end()) return {};
    const auto wanted = static_cast<std::size_t>(found - element.properties.begin());
    body.require_rows(element);
    if (vertices) values.reserve(element.count);
    for (std::uint64_t row = 0; row < element.count; ++row)
      read_row(body, element, [&](std::size_t i, double value) {
        if (i == wanted) values.push_back(static_cast<float>(value));
      });
    if (vertices) return values;
  }
  return values;
}

}  // namespace axial::io
