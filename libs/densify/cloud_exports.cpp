// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/cloud_exports.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/same_file.h"
#include "cloud/visibility.h"
#include "io/openmvs/mvs.h"
#include "io/ply/ply.h"

namespace axial::densify {
namespace fs = std::filesystem;

namespace {

std::size_t distinct_views(const SparsePoint& point) {
  std::size_t count = 0;
  std::uint32_t previous = kNoId;
  for (const SparseView& view : point.views) {
    count += view.image != previous ? 1 : 0;
    previous = view.image;
  }
  return count;
}

// What the exports share.
struct PointExport {
  Project& project;
  const ExportJob& job;
  const OutputOptions& output;
  const std::vector<fs::path>& inputs;
  const Context& context;

  io::PlyPlacement placement() const { return {project.frame, output.double_precision}; }

  // The output path with `suffix`. Error if it is a file that was read.
  fs::path file(const std::string& suffix) const {
    const fs::path path = fs::path(output.scene).replace_extension() += suffix;
    require_not_an_input(path, inputs, setting("output"));
    return path;
  }
};

WrittenCloud told(const PointExport& to, const fs::path& ply) {
  const Scene& scene = to.project.scene;
  to.context.info("{}: {} points", ply.string(), scene.points.size());
  return {ply, scene.points.size()};
}

WrittenCloud write(const PointExport& to, const std::string& suffix, bool with_scene) {
  const Project& project = to.project;
  const fs::path ply = to.file(suffix + ".ply");
  const fs::path scene = with_scene ? to.file(suffix + ".mvs") : fs::path();
  io::write_cloud_ply(ply, cloud_of(project.scene), true, to.placement());
  if (with_scene) {
    io::write_cameras_beside(scene, project, project.lenses, project.options.files, to.context);
    io::write_mvs(scene, project.scene, project.options.files.working_folder);
  }
  return told(to, ply);
}

WrittenCloud export_filtered(const PointExport& to) {
  const std::vector<long> visibility = cloud::visibility_of_points(to.project.scene);
  keep_points(to.project.scene,
              [&](std::size_t point) { return visibility[point] > to.job.filter_point_cloud; });
  return write(to, "_filtered", true);
}

WrittenCloud export_number_of_views(const PointExport& to) {
  const auto least = static_cast<std::size_t>(std::abs(to.job.export_number_views));
  keep_points(to.project.scene, [&](std::size_t point) {
    return distinct_views(to.project.scene.points[point]) >= least;
  });
  return write(to, fmt::format("_{}views", least), to.job.export_number_views < 0);
}

// Writes positions, colours and normals if the scene has them, confidence and value.
void write_scales(const fs::path& ply, const Scene& scene,
                  const std::vector<cloud::PointScale>& scales, const io::PlyPlacement& placement) {
  const bool colors = !scene.point_colors.empty(), normals = !scene.point_normals.empty();
  std::string bytes = fmt::format("ply\nformat binary_little_endian 1.0\n{}element vertex {}\n{}",
                                  io::geo_comment(placement), scene.points.size(),
                                  io::position_properties(placement));
  if (colors) bytes += "property uint8 red\nproperty uint8 green\nproperty uint8 blue\n";
  if (normals) bytes += "property float32 nx\nproperty float32 ny\nproperty float32 nz\n";
  bytes += "property float32 confidence\nproperty float32 value\nend_header\n";
  const auto add = [&](const void* data, std::size_t size) {
    bytes.append(static_cast<const char*>(data), size);
  };
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    io::append_position(bytes, scene.points[i].position, placement);
    if (colors) add(scene.point_colors[i].data(), 3);
    if (normals) add(scene.point_normals[i].data(), 3 * sizeof(float));
    add(&scales[i].confidence, sizeof(float));
    add(&scales[i].scale, sizeof(float));
  }
  write_atomically(ply, bytes);
}

WrittenCloud export_scales(const PointExport& to) {
  const Scene& scene = to.project.scene;
  const fs::path ply = to.file("_scale.ply");
  std::vector<cloud::PointScale> scales = cloud::scales_of_points(scene);
  for (cloud::PointScale& scale : scales) scale.scale *= static_cast<float>(to.job.estimate_scale);
  write_scales(ply, scene, scales, to.placement());
  return told(to, ply);
}

}  // namespace

void keep_points(Scene& scene, const std::function<bool(std::size_t point)>& kept) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    if (!kept(i)) continue;
    if (count != i) {
      scene.points[count] = std::move(scene.points[i]);
      if (!scene.point_normals.empty()) scene.point_normals[count] = scene.point_normals[i];
      if (!scene.point_colors.empty()) scene.point_colors[count] = scene.point_colors[i];
    }
    ++count;
  }
  scene.points.resize(count);
  if (!scene.point_normals.empty()) scene.point_normals.resize(count);
  if (!scene.point_colors.empty()) scene.point_colors.resize(count);
}

WrittenCloud export_cloud(Project project, const ExportJob& job, const OutputOptions& output,
                          const std::vector<fs::path>& inputs, const Context& context) {
  if (project.scene.points.empty()) fail_in(project.file(), "has no points to export");
  const PointExport to{project, job, output, inputs, context};
  if (job.filter_point_cloud < 0) return export_filtered(to);
  if (job.export_number_views != 0) return export_number_of_views(to);
  return export_scales(to);
}

}  // namespace axial::densify
