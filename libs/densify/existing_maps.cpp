// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/existing_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/log.h"
#include "densify/depth_stage.h"
#include "scene/resolution.h"

namespace axial::densify {
using axial::io::DmapOrigin;

namespace {

bool is_plain_pinhole(const CameraModel& camera) {
  return !camera.port && !camera.distortion;
}

// The points that the map's corners and centre see at the middle of its depth range.
std::vector<Eigen::Vector3d> points_seen(const DepthMap& map) {
  const double w = map.camera.width - 1, h = map.camera.height - 1;
  const auto near = static_cast<double>(map.min_depth), far = static_cast<double>(map.max_depth);
  const double depth = near > 0 ? std::sqrt(near * far) : far / 2;
  std::vector<Eigen::Vector3d> points;
  std::visit(
      [&](const auto& camera) {
        for (const auto& [u, v] : {std::pair{0.0, 0.0}, {w, 0.0}, {0.0, h}, {w, h}, {w / 2, h / 2}})
          points.push_back(map.pose.to_world(camera.ray({u, v}).at(depth)));
      },
      make_camera<double>(map.camera));
  return points;
}

// The largest distance [px] between the images of the same points in the map's camera and in the
// scene's camera, at the map's resolution.
double largest_shift(const DepthMap& map, const CameraModel& model, const Pose& pose) {
  const std::vector<Eigen::Vector3d> points = points_seen(map);
  const double w = map.camera.width - 1, h = map.camera.height - 1;
  const double us[] = {0, w, 0, w, w / 2}, vs[] = {0, 0, h, h, h / 2};
  double largest = 0;
  std::visit(
      [&](const auto& camera) {
        for (std::size_t i = 0; i < points.size(); ++i) {
          const auto seen = camera.project(pose.to_camera(points[i]));
          if (!seen.visible) {
            largest = std::numeric_limits<double>::infinity();
            return;
          }
          largest = std::max(largest, std::hypot(seen.pixel.x() - us[i], seen.pixel.y() - vs[i]));
        }
      },
      make_camera<double>(model));
  return largest;
}

// The image's camera at the resolution of its map. Error unless the map belongs to this camera.
CameraModel camera_of_map(const Project& project, const Settings& settings, std::size_t image,
                          DmapOrigin origin) {
  const std::string file = depth_map_path(project, settings, image).string();
  const SceneImage& scene_image = project.scene.images[image];
  if (origin == DmapOrigin::damaged)
    fail(
        "{}: the depth map or its side file is damaged: remove both files to fuse the other depth "
        "maps",
        file);
  if (origin == DmapOrigin::foreign && !is_plain_pinhole(scene_image.camera))
    fail("{}: is the depth map of a pinhole camera, but image {} has a port or a distorted lens",
         file, scene_image.path);
  const DepthMap map = io::read_dmap_header(file, side_to_read(origin));
  const cv::Size size(map.camera.width, map.camera.height);
  if (!same_shape(size, {scene_image.camera.width, scene_image.camera.height}))
    fail("{}: is {}x{}, but the camera of image {} is {}x{}", file, size.width, size.height,
         scene_image.path, scene_image.camera.width, scene_image.camera.height);
  CameraModel camera = scene_image.camera.resized(size.width, size.height);
  constexpr double kMostPixels = 1;
  if (const double shift = largest_shift(map, camera, scene_image.pose); !(shift < kMostPixels))
    fail(
        "{}: its camera projects the scene {:.1f} px away from the camera of image {}: the depth "
        "map was made with other poses or intrinsics",
        file, shift, scene_image.path);
  return camera;
}

void leave_out(const cv::Mat1b& mask, DepthMap& map) {
  cv::Mat1b left_out;
  cv::compare(mask, 0, left_out, cv::CMP_EQ);
  map.depth.setTo(0, left_out);
  for (cv::Mat plane : {cv::Mat(map.normal), cv::Mat(map.confidence)})
    if (!plane.empty()) plane.setTo(cv::Scalar::all(0), left_out);
}

}  // namespace

io::DmapSide side_to_read(DmapOrigin origin) {
  return origin == DmapOrigin::foreign ? io::DmapSide::ignored : io::DmapSide::used;
}

ExistingMaps find_existing_maps(const Project& project, const Settings& settings) {
  ExistingMaps maps(project.scene.images.size());
  // One map at a time: each is read completely, and the memory plan does not exist yet.
  for (const std::size_t image : project.part)
    maps[image] = io::dmap_status(depth_map_path(project, settings, image));
  return maps;
}

DepthMap read_final_map(const Project& project, const Settings& settings, const ExistingMaps& maps,
                        std::size_t image, const cv::Mat1b& mask) {
  const auto side = settings.make_maps ? io::DmapSide::used : side_to_read(maps[image].origin);
  DepthMap map = io::read_dmap(depth_map_path(project, settings, image), side).map;
  if (!settings.make_maps && !mask.empty()) leave_out(mask, map);
  if (cv::countNonZero(map.normal.reshape(1)) == 0) map.normal.release();
  return map;
}

void check_overwriting(const Project& project, const Settings& settings, const ExistingMaps& maps) {
  std::vector<std::size_t> foreign;
  for (const std::size_t image : project.part) {
    if (maps[image].origin == DmapOrigin::foreign) foreign.push_back(image);
    if (maps[image].origin == DmapOrigin::damaged)
      log_warning("{}: the depth map or its side file is damaged; the depth map is computed again",
                  depth_map_path(project, settings, image).string());
  }
  if (foreign.empty()) return;
  const std::string file = depth_map_path(project, settings, foreign.front()).string();
  if (settings.overwrite_dmaps) {
    log_info("{} and {} other depth maps of other programs are overwritten", file,
             foreign.size() - 1);
    return;
  }
  const bool fusable = std::ranges::all_of(foreign, [&](std::size_t image) {
    return is_plain_pinhole(project.scene.images[image].camera);
  });
  fail("{}: was written by another program ({} of {} depth maps were): {}move it away, or give {}",
       file, foreign.size(), project.part.size(),
       fusable ? "fuse the existing depth maps (" + settings.name_of("make_maps false") + "), "
               : "it counts as the depth map of a pinhole camera: ",
       settings.name_of("overwrite_dmaps true"));
}

void keep_images_with_maps(Project& project, const Settings& settings, const ExistingMaps& maps) {
  std::vector<std::size_t> kept;
  std::filesystem::path missing;  // the first missing map
  std::size_t foreign = 0;
  for (const std::size_t image : project.references) {
    const DmapOrigin origin = maps[image].origin;
    if (origin == DmapOrigin::none) {
      log_info("{}: has no depth map, left out", project.scene.images[image].path);
      if (missing.empty()) missing = depth_map_path(project, settings, image);
      continue;
    }
    project.views[image].camera = camera_of_map(project, settings, image, origin);
    foreign += origin == DmapOrigin::foreign ? 1 : 0;
    kept.push_back(image);
  }
  if (kept.empty())
    fail("{}: no depth map found: {} does not exist", settings.name_of("make_maps false"),
         depth_map_path(project, settings, project.references.front()).string());
  const std::string line = fmt::format("{} of {} images have a depth map, {} by other programs",
                                       kept.size(), project.references.size(), foreign);
  if (kept.size() < project.references.size())
    log_warning("{}; {}, for example, does not exist", line, missing.string());
  else
    log_info("{}", line);
  project.references = project.part = std::move(kept);
}

}  // namespace axial::densify
