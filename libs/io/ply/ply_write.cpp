// SPDX-License-Identifier: GPL-3.0-or-later
#include <fstream>

#include "base/atomic_file.h"
#include "base/error.h"
#include "bytes/private/atomic_stream.h"
#include "bytes/private/byte_writer.h"
#include "io/ply/ply.h"

namespace axial::io {
namespace {

constexpr const char* kStart = "ply\nformat binary_little_endian 1.0\n";
constexpr const char* kPosition = "property float32 x\nproperty float32 y\nproperty float32 z\n";
constexpr const char* kWorldPosition =
    "property float64 x\nproperty float64 y\nproperty float64 z\n";
constexpr const char* kColorProperties =
    "property uint8 red\nproperty uint8 green\nproperty uint8 blue\n";
constexpr const char* kUnseen = "property uint8 unseen\n";
constexpr const char* kNormal = "property float32 nx\nproperty float32 ny\nproperty float32 nz\n";

void require_length(std::size_t length, std::size_t points, const char* field,
                    const std::string& file) {
  if (length != points) fail_in(file, "the cloud has {} {} for {} points", length, field, points);
}

void check_views(const PointCloud& cloud, std::size_t before, const std::string& file) {
  if (cloud.view_begin.empty()) fail_in(file, "the cloud has no view lists");
  require_length(cloud.view_begin.size() - 1, cloud.size(), "view lists", file);
  if (cloud.view_begin.back() > cloud.view_images.size())
    fail_in(file, "the cloud's view lists end at {}, but there are {} views",
            cloud.view_begin.back(), cloud.view_images.size());
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (cloud.views_of(i).size() > 255)
      fail_in(file, "point {} has {} views, but the format counts them in a byte (at most 255)",
              before + i, cloud.views_of(i).size());
}

void write_vector(ByteWriter& out, const Eigen::Vector3f& v) {
  out.write(std::span(v.data(), 3));
}

void write_position(ByteWriter& out, const Eigen::Vector3f& v, const PlyPlacement& placement) {
  if (!placement.world) return write_vector(out, v);
  const Eigen::Vector3d world = placement.frame.to_world(v.cast<double>());
  out.write(std::span(world.data(), 3));
}

void write_views(ByteWriter& out, const PointCloud& cloud, std::size_t i, bool weights) {
  const std::span<const std::uint32_t> views = cloud.views_of(i);
  const auto size = static_cast<std::uint8_t>(views.size());
  out.write(size);
  out.write(views);
  if (!weights) return;
  out.write(size);
  out.write(std::span(cloud.view_weights).subspan(cloud.view_begin[i], views.size()));
}

// The header has the same length for any number of points.
std::string cloud_header(const CloudLayout& layout, const PlyPlacement& placement,
                         std::size_t points) {
  constexpr std::size_t kMostDigits = 20;
  const std::string count = std::to_string(points);
  std::string header = fmt::format("{}comment AxialMVS{}\n{}element vertex {}\n{}", kStart,
                                   std::string(kMostDigits - count.size(), ' '),
                                   geo_comment(placement), count, position_properties(placement));
  if (layout.colors) header += kColorProperties;
  if (layout.normals) header += kNormal;
  if (layout.views) header += "property list uint8 uint32 view_indices\n";
  if (layout.view_weights) header += "property list uint8 float32 view_weights\n";
  if (layout.errors) header += "property float32 error\nproperty float32 confidence\n";
  return header + "end_header\n";
}

}  // namespace

const char* position_properties(const PlyPlacement& placement) {
  return placement.world ? kWorldPosition : kPosition;
}

std::string geo_comment(const PlyPlacement& placement) {
  if (placement.world || placement.frame.is_world()) return {};
  const Eigen::Vector3d& o = placement.frame.origin;
  return fmt::format("comment geo_offset {} {} {}\n", o.x(), o.y(), o.z());
}

void append_position(std::string& bytes, const Eigen::Vector3f& position,
                     const PlyPlacement& placement) {
  ByteWriter out;
  write_position(out, position, placement);
  bytes += out.bytes();
}

struct CloudWriter::File {
  AtomicStream stream;
  CloudLayout layout;
  PlyPlacement placement;
  std::size_t points = 0;

  std::string name() const { return stream.name(); }

  void check(const PointCloud& portion) const {
    if (layout.colors) require_length(portion.colors.size(), portion.size(), "colors", name());
    if (layout.normals) require_length(portion.normals.size(), portion.size(), "normals", name());
    if (layout.views) check_views(portion, points, name());
    if (layout.view_weights)
      require_length(portion.view_weights.size(), portion.view_images.size(), "view weights",
                     name());
    if (layout.errors) require_length(portion.errors.size(), portion.size(), "errors", name());
    if (layout.errors)
      require_length(portion.confidences.size(), portion.size(), "confidences", name());
  }
};

CloudWriter::CloudWriter(const std::filesystem::path& path, const CloudLayout& layout,
                         const PlyPlacement& placement)
    : file_(new File{AtomicStream(path), layout, placement, 0}) {
  file_->stream.write(cloud_header(layout, placement, 0));
}

CloudWriter::~CloudWriter() = default;

std::size_t CloudWriter::size() const {
  return file_->points;
}

void CloudWriter::add(const PointCloud& portion) {
  const CloudLayout& layout = file_->layout;
  file_->check(portion);
  ByteWriter out;
  for (std::size_t i = 0; i < portion.size(); ++i) {
    write_position(out, portion.positions[i], file_->placement);
    if (layout.colors) out.write(std::span(portion.colors[i]));
    if (layout.normals) write_vector(out, portion.normals[i]);
    if (layout.views) write_views(out, portion, i, layout.view_weights);
    if (!layout.errors) continue;
    out.write(portion.errors[i]);
    out.write(portion.confidences[i]);
  }
  file_->stream.write(out.bytes());
  file_->points += portion.size();
}

void CloudWriter::add_file(const std::filesystem::path& written, std::size_t points) {
  const std::string header = cloud_header(file_->layout, file_->placement, points);
  std::string bytes(std::max<std::size_t>(header.size(), std::size_t{1} << 20), '\0');
  std::ifstream in(written, std::ios::binary);
  in.read(bytes.data(), static_cast<std::streamsize>(header.size()));
  if (!in || bytes.compare(0, header.size(), header) != 0)
    fail_in(written, "is not a cloud of {} points with the properties of {}", points,
            file_->name());
  while (in.read(bytes.data(), static_cast<std::streamsize>(bytes.size())) || in.gcount() > 0)
    file_->stream.write(std::string_view(bytes).substr(0, static_cast<std::size_t>(in.gcount())));
  if (in.bad()) fail_in(written, "cannot be read");
  file_->points += points;
}

void CloudWriter::finish() {
  file_->stream.finish(cloud_header(file_->layout, file_->placement, file_->points));
}

void write_cloud_ply(const std::filesystem::path& path, const PointCloud& cloud, bool with_views,
                     const PlyPlacement& placement) {
  const bool views = with_views && !cloud.view_begin.empty();
  CloudWriter out(path,
                  {!cloud.colors.empty(), !cloud.normals.empty(), views,
                   views && !cloud.view_weights.empty(), !cloud.errors.empty()},
                  placement);
  out.add(cloud);
  out.finish();
}

namespace {

// `property` may be null: no additional property.
void write_mesh(const std::filesystem::path& path, const Mesh& mesh, const VertexProperty* property,
                const PlyPlacement& placement) {
  if (!mesh.colors.empty())
    require_length(mesh.colors.size(), mesh.vertices.size(), "colors", path.string());
  if (!mesh.unseen.empty())
    require_length(mesh.unseen.size(), mesh.faces.size(), "marks of faces", path.string());
  ByteWriter out;
  out.text(fmt::format("{}{}element vertex {}\n{}", kStart, geo_comment(placement),
                       mesh.vertices.size(), position_properties(placement)));
  if (!mesh.colors.empty()) out.text(kColorProperties);
  if (property) out.text(fmt::format("property float32 {}\n", property->name));
  out.text(fmt::format("element face {}\nproperty list uint8 uint32 vertex_indices\n{}end_header\n",
                       mesh.faces.size(), mesh.unseen.empty() ? "" : kUnseen));
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    write_position(out, mesh.vertices[i], placement);
    if (!mesh.colors.empty()) out.write(std::span(mesh.colors[i]));
    if (property) out.write(property->values[i]);
  }
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    out.write(std::uint8_t{3});
    out.write(std::span(mesh.faces[f]));
    if (!mesh.unseen.empty()) out.write(mesh.unseen[f]);
  }
  write_atomically(path, out.bytes());
}

}  // namespace

void write_mesh_ply(const std::filesystem::path& path, const Mesh& mesh,
                    const PlyPlacement& placement) {
  write_mesh(path, mesh, nullptr, placement);
}

void write_mesh_ply(const std::filesystem::path& path, const Mesh& mesh,
                    const VertexProperty& property, const PlyPlacement& placement) {
  require_length(property.values.size(), mesh.vertices.size(), property.name.c_str(),
                 path.string());
  write_mesh(path, mesh, &property, placement);
}

}  // namespace axial::io
