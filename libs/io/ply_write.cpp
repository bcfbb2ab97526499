// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/atomic_file.h"
#include "base/error.h"
#include "io/byte_writer.h"
#include "io/ply.h"

namespace axial::io {
namespace {

constexpr const char* kStart = "ply\nformat binary_little_endian 1.0\n";
constexpr const char* kPosition = "property float32 x\nproperty float32 y\nproperty float32 z\n";
constexpr const char* kColor = "property uint8 red\nproperty uint8 green\nproperty uint8 blue\n";
constexpr const char* kNormal = "property float32 nx\nproperty float32 ny\nproperty float32 nz\n";

void require_length(std::size_t length, std::size_t points, const char* field,
                    const std::string& file) {
  if (length != 0 && length != points)
    fail("{}: the cloud has {} {} for {} points", file, length, field, points);
}

void check_cloud(const PointCloud& cloud, bool with_views, const std::string& file) {
  require_length(cloud.normals.size(), cloud.size(), "normals", file);
  require_length(cloud.colors.size(), cloud.size(), "colors", file);
  if (!with_views) return;
  require_length(cloud.view_begin.size() - 1, cloud.size(), "view lists", file);
  require_length(cloud.view_weights.size(), cloud.view_images.size(), "view weights", file);
  if (cloud.view_begin.back() > cloud.view_images.size())
    fail("{}: the cloud's view lists end at {}, but there are {} views", file,
         cloud.view_begin.back(), cloud.view_images.size());
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (cloud.views_of(i).size() > 255)
      fail("{}: point {} has {} views, but the format counts them in a byte (at most 255)", file, i,
           cloud.views_of(i).size());
}

void write_vector(ByteWriter& out, const Eigen::Vector3f& v) {
  out.write(std::span(v.data(), 3));
}

void write_views(ByteWriter& out, const PointCloud& cloud, std::size_t i) {
  const std::span<const std::uint32_t> views = cloud.views_of(i);
  const auto size = static_cast<std::uint8_t>(views.size());
  out.write(size);
  out.write(views);
  if (cloud.view_weights.empty()) return;
  out.write(size);
  out.write(std::span(cloud.view_weights).subspan(cloud.view_begin[i], views.size()));
}

}  // namespace

void write_cloud_ply(const std::filesystem::path& path, const PointCloud& cloud, bool with_views) {
  with_views = with_views && !cloud.view_begin.empty();
  check_cloud(cloud, with_views, path.string());
  ByteWriter out;
  out.text(fmt::format("{}element vertex {}\n{}", kStart, cloud.size(), kPosition));
  if (!cloud.colors.empty()) out.text(kColor);
  if (!cloud.normals.empty()) out.text(kNormal);
  if (with_views) out.text("property list uint8 uint32 view_indices\n");
  if (with_views && !cloud.view_weights.empty())
    out.text("property list uint8 float32 view_weights\n");
  out.text("end_header\n");
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    write_vector(out, cloud.positions[i]);
    if (!cloud.colors.empty()) out.write(std::span(cloud.colors[i]));
    if (!cloud.normals.empty()) write_vector(out, cloud.normals[i]);
    if (with_views) write_views(out, cloud, i);
  }
  write_atomically(path, out.bytes());
}

void write_mesh_ply(const std::filesystem::path& path, const Mesh& mesh) {
  require_length(mesh.colors.size(), mesh.vertices.size(), "colors", path.string());
  ByteWriter out;
  out.text(fmt::format("{}element vertex {}\n{}", kStart, mesh.vertices.size(), kPosition));
  if (!mesh.colors.empty()) out.text(kColor);
  out.text(fmt::format("element face {}\nproperty list uint8 uint32 vertex_indices\nend_header\n",
                       mesh.faces.size()));
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    write_vector(out, mesh.vertices[i]);
    if (!mesh.colors.empty()) out.write(std::span(mesh.colors[i]));
  }
  for (const auto& face : mesh.faces) {
    out.write(std::uint8_t{3});
    out.write(std::span(face));
  }
  write_atomically(path, out.bytes());
}

}  // namespace axial::io
