// SPDX-License-Identifier: GPL-3.0-or-later
#include <optional>

#include "base/atomic_file.h"
#include "base/error.h"
#include "io/ply/ply.h"
#include "private/ply/ply_rows.h"

namespace axial::io {
namespace {

PointCloud read_vertices(PlyBody& body, const PlyElement& element, const std::string& file,
                         const std::optional<Eigen::Vector3d>& shift) {
  body.require_rows(element);
  VertexRows rows(element, file, shift);
  PointCloud cloud = rows.empty_cloud();
  cloud.positions.reserve(element.count);
  for (std::size_t i = 0; i < element.count; ++i) rows.read(body, cloud);
  return cloud;
}

void read_faces(PlyBody& body, const PlyElement& element, const std::string& file, Mesh& mesh) {
  body.require_rows(element);
  std::size_t corners_at = find_property(element, "vertex_indices", true);
  if (corners_at == kNoProperty) corners_at = find_property(element, "vertex_index", true);
  if (corners_at == kNoProperty && element.count > 0)
    fail("{}: element face has no list vertex_indices", file);
  const std::size_t unseen_at = find_property(element, "unseen", false);
  if (unseen_at != kNoProperty) mesh.unseen.resize(mesh.faces.size());  // strips have no marks
  mesh.faces.reserve(mesh.faces.size() + element.count);
  std::vector<double> corners;
  double unseen = 0;
  for (std::size_t i = 0; i < element.count; ++i) {
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      if (property.is_list)
        read_list(body, property, p == corners_at ? &corners : nullptr);
      else if (const double value = body.scalar(property.type, property.name); p == unseen_at)
        unseen = value;
    }
    if (corners.size() < 3)
      fail("{}: face {} has {} corners, at least 3 are needed", file, i, corners.size());
    for (std::size_t k = 2; k < corners.size(); ++k)
      mesh.faces.push_back({as_index(corners[0], "vertex_indices", i, file),
                            as_index(corners[k - 1], "vertex_indices", i, file),
                            as_index(corners[k], "vertex_indices", i, file)});
    if (unseen_at != kNoProperty) mesh.unseen.resize(mesh.faces.size(), unseen != 0);
  }
}

// Strips of triangles, as the models of the Stanford repository have them. -1 ends a strip. Every
// second triangle of a strip has its corners in the opposite order.
void read_strips(PlyBody& body, const PlyElement& element, const std::string& file, Mesh& mesh) {
  body.require_rows(element);
  const std::size_t corners_at = find_property(element, "vertex_indices", true);
  std::vector<double> corners;
  for (std::size_t i = 0; i < element.count; ++i) {
    for (std::size_t p = 0; p < element.properties.size(); ++p)
      if (const PlyProperty& property = element.properties[p]; property.is_list)
        read_list(body, property, p == corners_at ? &corners : nullptr);
      else
        body.scalar(property.type, property.name);
    std::vector<std::uint32_t> strip;
    for (const double corner : corners) {
      if (corner == -1) {
        strip.clear();
        continue;
      }
      strip.push_back(as_index(corner, "vertex_indices", i, file));
      const std::size_t n = strip.size();
      if (n < 3) continue;
      const std::uint32_t a = strip[n - 3], b = strip[n - 2], c = strip[n - 1];
      if (a == b || b == c || c == a) continue;
      mesh.faces.push_back(n % 2 == 1 ? std::array{a, b, c} : std::array{b, a, c});
    }
  }
}

void check_faces(const Mesh& mesh, const std::string& file) {
  for (const auto& face : mesh.faces)
    for (const std::uint32_t corner : face)
      if (corner >= mesh.vertices.size())
        fail("{}: a face refers to vertex {}, but there are {}", file, corner,
             mesh.vertices.size());
}

PointCloud read_cloud(const std::filesystem::path& path, const LocalFrame* frame) {
  const std::string file = path.string();
  const std::string bytes = read_file(path);
  const PlyHeader header = parse_ply_header(bytes, file);
  if (!find_element(header, "vertex")) fail("{}: has no element vertex", file);
  PlyBody body(bytes, file, header);
  PointCloud cloud;
  for (const PlyElement& element : header.elements) {
    if (&element == find_element(header, "vertex"))
      cloud = read_vertices(body, element, file, shift_into(frame, header));
    else
      skip_rows(body, element);
  }
  body.require_end();
  return cloud;
}

Mesh read_mesh(const std::filesystem::path& path, const LocalFrame* frame) {
  const std::string file = path.string();
  const std::string bytes = read_file(path);
  const PlyHeader header = parse_ply_header(bytes, file);
  if (!find_element(header, "vertex")) fail("{}: has no element vertex", file);
  if (!find_element(header, "face") && !find_element(header, "tristrips"))
    fail("{}: is not a mesh: it has no element face", file);
  PlyBody body(bytes, file, header);
  Mesh mesh;
  for (const PlyElement& element : header.elements) {
    if (&element == find_element(header, "vertex")) {
      PointCloud cloud = read_vertices(body, element, file, shift_into(frame, header));
      mesh.vertices = std::move(cloud.positions);
      mesh.colors = std::move(cloud.colors);
    } else if (&element == find_element(header, "face")) {
      read_faces(body, element, file, mesh);
    } else if (&element == find_element(header, "tristrips")) {
      read_strips(body, element, file, mesh);
    } else {
      skip_rows(body, element);
    }
  }
  body.require_end();
  check_faces(mesh, file);
  if (!mesh.unseen.empty()) mesh.unseen.resize(mesh.faces.size());  // strips have no marks
  return mesh;
}

}  // namespace

PointCloud read_cloud_ply(const std::filesystem::path& path) {
  return read_cloud(path, nullptr);
}

PointCloud read_cloud_ply(const std::filesystem::path& path, const LocalFrame& frame) {
  return read_cloud(path, &frame);
}

Mesh read_mesh_ply(const std::filesystem::path& path) {
  return read_mesh(path, nullptr);
}

Mesh read_mesh_ply(const std::filesystem::path& path, const LocalFrame& frame) {
  return read_mesh(path, &frame);
}

}  // namespace axial::io
