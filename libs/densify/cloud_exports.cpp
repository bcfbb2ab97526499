// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud_exports.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/log.h"
#include "base/same_file.h"
#include "cloud/visibility.h"
#include "fusion_stage.h"
#include "io/mvs.h"
#include "io/ply.h"
#include "outputs.h"

namespace densify {
namespace fs = std::filesystem;

namespace {

fs::path beside_output(const Options& options, const std::string& suffix) {
  fs::path path = options.output;
  path.replace_extension();
  return path += suffix;
}

std::size_t distinct_views(const axial::SparsePoint& point) {
  std::size_t count = 0;
  std::uint32_t previous = axial::kNoId;
  for (const axial::SparseView& view : point.views) {
    count += view.image != previous ? 1 : 0;
    previous = view.image;
  }
  return count;
}

// The output path with `suffix`. Error if it is a file that was read.
fs::path checked_output(const Options& options, const std::string& suffix) {
  const fs::path path = beside_output(options, suffix);
  axial::require_not_an_input(path, scene_files(options), "--output-file");
  return path;
}

void write(const Project& project, const Options& options, const std::string& suffix,
           bool with_scene) {
  const fs::path ply = checked_output(options, suffix + ".ply");
  Options of_scene = options;
  of_scene.output = with_scene ? checked_output(options, suffix + ".mvs") : fs::path();
  axial::io::write_cloud_ply(ply, cloud_of(project.scene), true, placement_of(project, options));
  if (with_scene) {
    write_cameras_beside_output(project, of_scene);
    axial::io::write_mvs(of_scene.output, project.scene, options.parsed.common.working_folder);
  }
  axial::log_info("{}: {} points", ply.string(), project.scene.points.size());
}

void export_filtered(Project& project, const Options& options) {
  const std::vector<long> visibility = axial::cloud::visibility_of_points(project.scene);
  keep_points(project.scene,
              [&](std::size_t point) { return visibility[point] > options.filter_point_cloud; });
  write(project, options, "_filtered", true);
}

void export_number_of_views(Project& project, const Options& options) {
  const auto least = static_cast<std::size_t>(std::abs(options.export_number_views));
  keep_points(project.scene, [&](std::size_t point) {
    return distinct_views(project.scene.points[point]) >= least;
  });
  write(project, options, fmt::format("_{}views", least), options.export_number_views < 0);
}

// Writes positions, colours and normals if the scene has them, confidence and value.
void write_scales(const fs::path& ply, const axial::Scene& scene,
                  const std::vector<axial::cloud::PointScale>& scales,
                  const axial::io::PlyPlacement& placement) {
  const bool colors = !scene.point_colors.empty(), normals = !scene.point_normals.empty();
  std::string bytes = fmt::format("ply\nformat binary_little_endian 1.0\n{}element vertex {}\n{}",
                                  axial::io::geo_comment(placement), scene.points.size(),
                                  axial::io::position_properties(placement));
  if (colors) bytes += "property uint8 red\nproperty uint8 green\nproperty uint8 blue\n";
  if (normals) bytes += "property float32 nx\nproperty float32 ny\nproperty float32 nz\n";
  bytes += "property float32 confidence\nproperty float32 value\nend_header\n";
  const auto add = [&](const void* data, std::size_t size) {
    bytes.append(static_cast<const char*>(data), size);
  };
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    axial::io::append_position(bytes, scene.points[i].position, placement);
    if (colors) add(scene.point_colors[i].data(), 3);
    if (normals) add(scene.point_normals[i].data(), 3 * sizeof(float));
    add(&scales[i].confidence, sizeof(float));
    add(&scales[i].scale, sizeof(float));
  }
  axial::write_atomically(ply, bytes);
}

void export_scales(const Project& project, const Options& options) {
  const axial::Scene& scene = project.scene;
  const fs::path ply = checked_output(options, "_scale.ply");
  std::vector<axial::cloud::PointScale> scales = axial::cloud::scales_of_points(scene);
  for (axial::cloud::PointScale& scale : scales)
    scale.scale *= static_cast<float>(options.estimate_scale);
  write_scales(ply, scene, scales, placement_of(project, options));
  axial::log_info("{}: {} points", ply.string(), scene.points.size());
}

}  // namespace

axial::PointCloud cloud_of(const axial::Scene& scene) {
  axial::PointCloud cloud;
  cloud.view_begin.push_back(0);
  for (const axial::SparsePoint& point : scene.points) {
    cloud.positions.push_back(point.position);
    for (const axial::SparseView& view : point.views) {
      cloud.view_images.push_back(view.image);
      cloud.view_weights.push_back(view.confidence);
    }
    cloud.view_begin.push_back(cloud.view_images.size());
  }
  cloud.normals = scene.point_normals;
  cloud.colors = scene.point_colors;
  return cloud;
}

void keep_points(axial::Scene& scene, const std::function<bool(std::size_t point)>& kept) {
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

bool only_exports(const Options& options) {
  return options.filter_point_cloud < 0 || options.export_number_views != 0 ||
         options.estimate_scale > 0;
}

void export_cloud(Project project, const Options& options) {
  if (project.scene.points.empty())
    axial::fail("{}: has no points to export", options.input.string());
  if (options.filter_point_cloud < 0) return export_filtered(project, options);
  if (options.export_number_views != 0) return export_number_of_views(project, options);
  export_scales(project, options);
}

}  // namespace densify
