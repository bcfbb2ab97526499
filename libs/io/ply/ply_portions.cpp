// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "base/error.h"
#include "io/ply/ply.h"
#include "ply/private/ply_rows.h"
#include "ply/private/ply_stream.h"

namespace axial::io {

const PlyElement& vertex_element(const PlyStream& stream) {
  const PlyElement* vertices = find_element(stream.header(), "vertex");
  if (!vertices) fail_in(stream.file(), "has no element vertex");
  return *vertices;
}

void for_each_vertex(PlyStream& stream, const std::function<bool(PlyBody&)>& read) {
  const PlyElement& vertices = vertex_element(stream);
  for (const PlyElement& element : stream.header().elements) {
    if (&element == &vertices) return stream.for_each_row(read);
    stream.for_each_row([rows = PlyRows(element)](PlyBody& body) {
      rows.read(body);
      return true;
    });
  }
}

void read_cloud_portions(const std::filesystem::path& path, const LocalFrame* frame,
                         std::size_t points, const CloudPortionSink& sink) {
  PlyStream stream(path);
  const PlyElement& vertices = vertex_element(stream);
  VertexRows rows(vertices, path.string(), shift_into(frame, stream.header()));
  PointCloud portion = rows.empty_cloud();
  for_each_vertex(stream, [&](PlyBody& body) {
    rows.read(body, portion);
    if (portion.size() >= points) sink(std::exchange(portion, rows.empty_cloud()), vertices.count);
    return true;
  });
  if (portion.size() > 0) sink(std::move(portion), vertices.count);
}

PlyPlace ply_place(const std::filesystem::path& path) {
  PlyStream stream(path);
  PlyPlace place;
  if (stream.header().geo_offset) place.frame.origin = *stream.header().geo_offset;
  const PlyElement& vertices = vertex_element(stream);
  if (vertices.count == 0) return place;
  VertexRows rows(vertices, path.string(), {});
  for_each_vertex(stream, [&](PlyBody& body) {
    rows.read(body);
    return false;
  });
  place.first_vertex = place.frame.to_world(rows.stored_position());
  place.is_float =
      vertices.properties[find_property(vertices, "x", false)].type == PlyType::kFloat32;
  return place;
}

bool ply_has_faces(const std::filesystem::path& path) {
  const PlyStream stream(path);
  for (const char* name : {"face", "tristrips"})
    if (const PlyElement* faces = find_element(stream.header(), name); faces && faces->count > 0)
      return true;
  return false;
}

}  // namespace axial::io
