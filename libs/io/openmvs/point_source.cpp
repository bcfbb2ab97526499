// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/openmvs/point_source.h"

#include <algorithm>
#include <fstream>

#include "base/error.h"
#include "base/heap_bytes.h"
#include "io/frames/lost_offset.h"
#include "io/ply/ply.h"
#include "io/textured/textured_mesh.h"
#include "ply/private/ply_header.h"

namespace axial::io {
namespace fs = std::filesystem;

namespace {

SparsePoint sparse_point(const PointCloud& cloud, std::size_t i, std::size_t image_count,
                         const std::string& file) {
  SparsePoint point;
  point.position = cloud.positions[i];
  if (!point.position.allFinite()) fail_in(file, "point {} is not finite", i);
  for (std::size_t k = cloud.view_begin[i]; k < cloud.view_begin[i + 1]; ++k) {
    const std::uint32_t image = cloud.view_images[k];
    if (image >= image_count)
      fail_in(file, "point {} is seen by image {}, but the scene has {}", i, image, image_count);
    point.views.push_back({image, cloud.view_weights.empty() ? 0.0f : cloud.view_weights[k]});
  }
  std::ranges::stable_sort(point.views, {}, &SparseView::image);
  return point;
}

// is_without_offset(), and states it in a line of `context`.
bool is_silently_in(const LocalFrame& frame, const std::filesystem::path& file,
                    const Context& context) {
  if (!is_without_offset(frame, file)) return false;
  tell_lost_offset(file, frame, context);
  return true;
}

}  // namespace

TexturedMesh read_textured_mesh_of_scene(const LocalFrame& frame, const fs::path& path,
                                         const Context& context) {
  return is_silently_in(frame, path, context) ? read_textured_mesh(path, {}, context)
                                              : read_textured_mesh(path, frame, context);
}

PointCloud read_cloud_of_scene(const LocalFrame& frame, const std::filesystem::path& ply,
                               const Context& context) {
  return is_silently_in(frame, ply, context) ? read_cloud_ply(ply) : read_cloud_ply(ply, frame);
}

void read_cloud_of_scene_in_portions(const LocalFrame& frame, const std::filesystem::path& ply,
                                     std::size_t points, const CloudPortionSink& sink,
                                     const Context& context) {
  read_cloud_portions(ply, is_silently_in(frame, ply, context) ? nullptr : &frame, points, sink);
}

Mesh read_mesh_of_scene(const LocalFrame& frame, const std::filesystem::path& mesh,
                        const Context& context) {
  return is_silently_in(frame, mesh, context) ? read_shape(mesh) : read_shape(mesh, frame);
}

void use_point_cloud(Scene& scene, const LocalFrame& frame, const std::filesystem::path& ply,
                     const Context& context) {
  const std::string file = ply.string();
  PointCloud cloud = read_cloud_of_scene(frame, ply, context);
  if (cloud.view_begin.empty())
    fail_in(file, "has no view_indices, which list the images that see a point");
  scene.points.clear();
  scene.points.reserve(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i)
    scene.points.push_back(sparse_point(cloud, i, scene.images.size(), file));
  scene.point_normals = std::move(cloud.normals);
  scene.point_colors = std::move(cloud.colors);
  context.info("{}: {} points replace the scene's points", file, scene.points.size());
}

namespace {

struct PlyCounts {
  std::uint64_t file_bytes = 0, points = 0, observations = 0;
  bool normals = false, colors = false;
};

// Only for files whose header has at most `kHeader` bytes.
std::optional<PlyCounts> count_ply(const std::filesystem::path& ply) {
  constexpr std::size_t kHeader = 1u << 16;
  std::error_code error;
  PlyCounts counts;
  counts.file_bytes = std::filesystem::file_size(ply, error);
  if (error) return {};  // also for a pipe, whose opening would wait for a writer
  std::ifstream in(ply, std::ios::binary);
  if (!in) return {};
  std::string bytes(kHeader, '\0');
  in.read(bytes.data(), kHeader);
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  PlyHeader header;
  try {
    header = parse_ply_header(bytes, ply.string());
  } catch (const Error&) {
    return {};
  }
  if (header.elements.empty() || header.elements.front().name != "vertex") return {};
  const PlyElement& vertex = header.elements.front();
  std::uint64_t fixed = 0, view = 0;
  bool only_views = header.elements.size() == 1 && header.format != PlyFormat::kAscii;
  for (const PlyProperty& property : vertex.properties) {
    fixed += ply_size(property.is_list ? property.count_type : property.type);
    if (property.is_list) view += ply_size(property.type);
    only_views &= !property.is_list || property.name.starts_with("view_");
    counts.normals |= property.name == "nx";
    counts.colors |= property.name == "red";
  }
  const bool text = header.format == PlyFormat::kAscii;
  const std::uint64_t body = counts.file_bytes - header.body;
  if (fixed == 0 || vertex.count > body / (text ? 2 * vertex.properties.size() : fixed)) return {};
  counts.points = vertex.count;
  if (only_views && view > 0) counts.observations = (body - vertex.count * fixed) / view;
  return counts;
}

// The memory of a PointCloud.
std::uint64_t cloud_bytes(const PlyCounts& cloud) {
  const std::uint64_t vectors = cloud.points * (cloud.normals ? 2 : 1);
  return vectors * sizeof(Eigen::Vector3f) + (cloud.colors ? cloud.points * sizeof(Rgb) : 0) +
         cloud.points * sizeof(std::size_t) +
         cloud.observations * (sizeof(std::uint32_t) + sizeof(float));
}

}  // namespace

std::uint64_t bytes_to_read_cloud(const std::filesystem::path& ply) {
  const std::optional<PlyCounts> cloud = count_ply(ply);
  return cloud ? cloud->file_bytes + cloud_bytes(*cloud) : 0;
}

std::optional<PointSourceCounts> count_point_cloud(const std::filesystem::path& ply,
                                                   const MvsCounts& scene) {
  const std::optional<PlyCounts> cloud = count_ply(ply);
  if (!cloud) return {};
  const auto in_file = [](const MvsCounts& of) {
    return 20 * of.points + 8 * of.observations + 12 * of.normals + 3 * of.colors;
  };
  PointSourceCounts counts{scene};
  counts.scene.points = cloud->points;
  counts.scene.observations = cloud->observations;
  counts.scene.normals = cloud->normals ? cloud->points : 0;
  counts.scene.colors = cloud->colors ? cloud->points : 0;
  counts.scene.file_bytes += in_file(counts.scene) - in_file(scene);
  const std::uint64_t views = cloud->observations / std::max<std::uint64_t>(cloud->points, 1);
  counts.scene.view_list_bytes = cloud->points * heap_bytes(views * sizeof(SparseView));
  const std::uint64_t points = cloud->points * sizeof(SparsePoint) + counts.scene.view_list_bytes;
  counts.reading_bytes = cloud_bytes(*cloud) + std::max(cloud->file_bytes, points);
  return counts;
}

}  // namespace axial::io
