// SPDX-License-Identifier: GPL-3.0-or-later
#include <optional>

#include "base/atomic_file.h"
#include "base/error.h"
#include "io/ply/ply.h"
#include "ply/private/ply_rows.h"

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
  PlyRows rows(element);
  std::vector<double> corners;
  double unseen = 0;
  if (!rows.store("vertex_indices", corners) && !rows.store("vertex_index", corners) &&
      element.count > 0)
    fail_in(file, "element face has no list vertex_indices");
  const bool marked = rows.store("unseen", unseen);
  if (marked) mesh.unseen.resize(mesh.faces.size());  // strips have no marks
  mesh.faces.reserve(mesh.faces.size() + element.count);
  for (std::size_t i = 0; i < element.count; ++i) {
    rows.read(body);
    if (corners.size() < 3)
      fail_in(file, "face {} has {} corners, at least 3 are needed", i, corners.size());
    for (std::size_t k = 2; k < corners.size(); ++k)
      mesh.faces.push_back({as_index(corners[0], "vertex_indices", i, file),
                            as_index(corners[k - 1], "vertex_indices", i, file),
                            as_index(corners[k], "vertex_indices", i, file)});
    if (marked) mesh.unseen.resize(mesh.faces.size(), unseen != 0);
  }
}

// Strips of triangles, as the models of the Stanford repository have them. -1 ends a strip. Every
// second triangle of a strip has its corners in the opposite order.
void read_strips(PlyBody& body, const PlyElement& element, const std::string& file, Mesh& mesh) {
  body.require_rows(element);
  PlyRows rows(element);
  std::vector<double> corners;
  rows.store("vertex_indices", corners);
  for (std::size_t i = 0; i < element.count; ++i) {
    rows.read(body);
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
        fail_in(file, "a face refers to vertex {}, but there are {}", corner, mesh.vertices.size());
}

// Reads the elements of a file in their order: read(body, element) reads the rows of one.
template <class Read>
void read_elements(const std::string& bytes, const std::string& file, const PlyHeader& header,
                   Read read) {
  if (!find_element(header, "vertex")) fail_in(file, "has no element vertex");
  PlyBody body(bytes, file, header);
  for (const PlyElement& element : header.elements) read(body, element);
  body.require_end();
}

PointCloud read_cloud(const std::filesystem::path& path, const LocalFrame* frame) {
  const std::string file = path.string(), bytes = read_file(path);
  const PlyHeader header = parse_ply_header(bytes, file);
  PointCloud cloud;
  read_elements(bytes, file, header, [&](PlyBody& body, const PlyElement& element) {
    if (&element == find_element(header, "vertex"))
      cloud = read_vertices(body, element, file, shift_into(frame, header));
    else
      skip_rows(body, element);
  });
  return cloud;
}

void require_faces(const PlyHeader& header, const std::string& file) {
  if (find_element(header, "vertex") && !find_element(header, "face") &&
      !find_element(header, "tristrips"))
    fail_in(file, "is not a mesh: it has no element face");
}

Mesh read_mesh(const std::filesystem::path& path, const LocalFrame* frame) {
  const std::string file = path.string(), bytes = read_file(path);
  const PlyHeader header = parse_ply_header(bytes, file);
  require_faces(header, file);
  Mesh mesh;
  read_elements(bytes, file, header, [&](PlyBody& body, const PlyElement& element) {
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
  });
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

std::vector<float> read_vertex_property(const std::filesystem::path& path,
                                        const std::string& name) {
  const std::string file = path.string(), bytes = read_file(path);
  const PlyHeader header = parse_ply_header(bytes, file);
  PlyBody body(bytes, file, header);
  std::vector<float> values;
  for (const PlyElement& element : header.elements) {
    if (element.name != "vertex") {
      skip_rows(body, element);
      continue;
    }
    PlyRows rows(element);
    double value = 0;
    if (!rows.store(name, value)) return {};
    body.require_rows(element);
    values.reserve(element.count);
    for (std::uint64_t row = 0; row < element.count; ++row) {
      rows.read(body);
      values.push_back(static_cast<float>(value));
    }
    return values;
  }
  return values;
}

}  // namespace axial::io
