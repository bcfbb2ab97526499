// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "base/atomic_file.h"
#include "base/error.h"
#include "io/ply/ply.h"
#include "private/ply/ply_header.h"

namespace axial::io {
namespace {

// The slot of a vertex row that receives a property's value.
enum Slot : std::size_t { kX, kY, kZ, kNx, kNy, kNz, kRed, kGreen, kBlue, kSlots };
constexpr std::array<const char*, kSlots> kSlotNames{"x",  "y",   "z",     "nx",  "ny",
                                                     "nz", "red", "green", "blue"};

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

std::size_t find_property(const PlyElement& element, const std::string& name, bool list) {
  for (std::size_t i = 0; i < element.properties.size(); ++i)
    if (element.properties[i].name == name && element.properties[i].is_list == list) return i;
  return kNone;
}

const PlyElement* find_element(const PlyHeader& header, const std::string& name) {
  for (const PlyElement& element : header.elements)
    if (element.name == name) return &element;
  return nullptr;
}

// Finds the properties of interest of an element, and holds the values of the last row read.
class VertexRow {
 public:
  explicit VertexRow(const PlyElement& element)
      : element_(element), slot_of_(element.properties.size(), kNone) {
    for (std::size_t slot = 0; slot < kSlots; ++slot) {
      std::size_t i = find_property(element, kSlotNames[slot], false);
      if (i == kNone && slot >= kRed)
        i = find_property(element, std::string("diffuse_") + kSlotNames[slot], false);
      has_[slot] = i != kNone;
      if (i != kNone) slot_of_[i] = slot;
    }
    indices_ = find_property(element, "view_indices", true);
    weights_ = find_property(element, "view_weights", true);
  }

  bool has(Slot first) const { return has_[first] && has_[first + 1] && has_[first + 2]; }
  bool has_views() const { return indices_ != kNone; }
  bool has_weights() const { return weights_ != kNone; }

  void read(PlyBody& body) {
    for (std::size_t i = 0; i < element_.properties.size(); ++i) {
      const PlyProperty& property = element_.properties[i];
      if (property.is_list) {
        read_list(body, property, i == indices_ ? &indices : i == weights_ ? &weights : nullptr);
      } else {
        const double value = body.scalar(property.type, property.name);
        if (slot_of_[i] != kNone) values_[slot_of_[i]] = value;
      }
    }
  }

  Eigen::Vector3d numbers(Slot first) const {
    return {values_[first], values_[first + 1], values_[first + 2]};
  }
  Eigen::Vector3f vector(Slot first) const { return numbers(first).cast<float>(); }

  // Integer colours are in 0..255; some writers store floats in [0, 255]. Values outside are
  // clamped.
  Rgb color() const {
    Rgb rgb;
    for (std::size_t c = 0; c < 3; ++c) {
      const double value = values_[kRed + c];
      rgb[c] = static_cast<std::uint8_t>(value >= 0 && value <= 255 ? value
                                         : value > 255              ? 255
                                                                    : 0);
    }
    return rgb;
  }

  static void read_list(PlyBody& body, const PlyProperty& property, std::vector<double>* into) {
    if (into) into->clear();
    const std::size_t size = body.list_size(property);
    for (std::size_t k = 0; k < size; ++k) {
      const double value = body.scalar(property.type, property.name);
      if (into) into->push_back(value);
    }
  }

  std::vector<double> indices, weights;  // lists of the last row read

 private:
  const PlyElement& element_;
  std::vector<std::size_t> slot_of_;  // indexed by property
  std::array<bool, kSlots> has_{};
  std::array<double, kSlots> values_{};
  std::size_t indices_ = kNone, weights_ = kNone;
};

void require_finite(const Eigen::Vector3f& v, const char* field, std::size_t row,
                    const std::string& file) {
  if (!v.allFinite()) fail("{}: vertex {} has a {} that is not finite", file, row, field);
}

std::uint32_t as_index(double value, const char* field, std::size_t row, const std::string& file) {
  if (!(value >= 0 && value <= 4294967295.0) || value != std::trunc(value))
    fail("{}: {} of row {} contains {}, which is not an index", file, field, row, value);
  return static_cast<std::uint32_t>(value);
}

void append_views(const VertexRow& row, std::size_t index, const std::string& file,
                  PointCloud& cloud) {
  if (row.has_weights() && row.weights.size() != row.indices.size())
    fail("{}: vertex {} has {} view_indices but {} view_weights", file, index, row.indices.size(),
         row.weights.size());
  for (const double value : row.indices)
    cloud.view_images.push_back(as_index(value, "view_indices", index, file));
  if (row.has_weights())
    for (const double value : row.weights) cloud.view_weights.push_back(static_cast<float>(value));
  cloud.view_begin.push_back(cloud.view_images.size());
}

void skip_rows(PlyBody& body, const PlyElement& element) {
  body.require_rows(element);
  for (std::uint64_t i = 0; i < element.count; ++i)
    for (const PlyProperty& property : element.properties)
      if (property.is_list)
        VertexRow::read_list(body, property, nullptr);
      else
        body.scalar(property.type, property.name);
}

// The shift of the stored positions into `frame`; nothing if they stay as stored.
std::optional<Eigen::Vector3d> shift_into(const LocalFrame* frame, const PlyHeader& header) {
  if (!frame) return {};
  const Eigen::Vector3d shift = header.geo_offset.value_or(Eigen::Vector3d::Zero()) - frame->origin;
  if (shift.isZero(0)) return {};
  return shift;
}

PointCloud read_vertices(PlyBody& body, const PlyElement& element, const std::string& file,
                         const std::optional<Eigen::Vector3d>& shift) {
  body.require_rows(element);
  VertexRow row(element);
  if (!row.has(kX)) fail("{}: element vertex has no x, y or z", file);
  PointCloud cloud;
  cloud.positions.reserve(element.count);
  if (row.has_views()) cloud.view_begin.push_back(0);
  for (std::size_t i = 0; i < element.count; ++i) {
    row.read(body);
    cloud.positions.push_back(shift ? (row.numbers(kX) + *shift).cast<float>() : row.vector(kX));
    require_finite(cloud.positions.back(), "position", i, file);
    if (row.has(kNx)) {
      cloud.normals.push_back(row.vector(kNx));
      require_finite(cloud.normals.back(), "normal", i, file);
    }
    if (row.has(kRed)) cloud.colors.push_back(row.color());
    if (row.has_views()) append_views(row, i, file, cloud);
  }
  return cloud;
}

void read_faces(PlyBody& body, const PlyElement& element, const std::string& file, Mesh& mesh) {
  body.require_rows(element);
  std::size_t corners_at = find_property(element, "vertex_indices", true);
  if (corners_at == kNone) corners_at = find_property(element, "vertex_index", true);
  if (corners_at == kNone && element.count > 0)
    fail("{}: element face has no list vertex_indices", file);
  mesh.faces.reserve(element.count);
  std::vector<double> corners;
  for (std::size_t i = 0; i < element.count; ++i) {
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      if (property.is_list)
        VertexRow::read_list(body, property, p == corners_at ? &corners : nullptr);
      else
        body.scalar(property.type, property.name);
    }
    if (corners.size() < 3)
      fail("{}: face {} has {} corners, at least 3 are needed", file, i, corners.size());
    for (std::size_t k = 2; k < corners.size(); ++k)
      mesh.faces.push_back({as_index(corners[0], "vertex_indices", i, file),
                            as_index(corners[k - 1], "vertex_indices", i, file),
                            as_index(corners[k], "vertex_indices", i, file)});
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
  if (!find_element(header, "face")) fail("{}: is not a mesh: it has no element face", file);
  PlyBody body(bytes, file, header);
  Mesh mesh;
  for (const PlyElement& element : header.elements) {
    if (&element == find_element(header, "vertex")) {
      PointCloud cloud = read_vertices(body, element, file, shift_into(frame, header));
      mesh.vertices = std::move(cloud.positions);
      mesh.colors = std::move(cloud.colors);
    } else if (&element == find_element(header, "face")) {
      read_faces(body, element, file, mesh);
    } else {
      skip_rows(body, element);
    }
  }
  body.require_end();
  check_faces(mesh, file);
  return mesh;
}

// Reads the first vertex after skipping the elements before it.
Eigen::Vector3d first_vertex(std::string_view bytes, const std::string& file,
                             const PlyHeader& header, const PlyElement& vertices) {
  PlyBody body(bytes, file, header);
  for (const PlyElement& element : header.elements) {
    if (&element == &vertices) break;
    skip_rows(body, element);
  }
  body.require_rows(vertices);
  VertexRow row(vertices);
  if (!row.has(kX)) fail("{}: element vertex has no x, y or z", file);
  row.read(body);
  require_finite(row.vector(kX), "position", 0, file);
  return row.numbers(kX);
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

PlyPlace ply_place(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  const PlyHeader header = parse_ply_header(bytes, path.string());
  PlyPlace place;
  if (header.geo_offset) place.frame.origin = *header.geo_offset;
  const PlyElement* vertices = find_element(header, "vertex");
  if (!vertices) fail("{}: has no element vertex", path.string());
  if (vertices->count == 0) return place;
  place.first_vertex = place.frame.to_world(first_vertex(bytes, path.string(), header, *vertices));
  place.is_float =
      vertices->properties[find_property(*vertices, "x", false)].type == PlyType::kFloat32;
  return place;
}

bool ply_has_faces(const std::filesystem::path& path) {
  const PlyHeader header = parse_ply_header(read_file(path), path.string());
  const PlyElement* faces = find_element(header, "face");
  return faces && faces->count > 0;
}

}  // namespace axial::io
