// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/existing_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "densify/map_stages.h"
#include "scene/resolution.h"

namespace axial::densify {
using axial::io::DmapOrigin;

namespace {

bool is_plain_pinhole(const CameraModel& camera) {
  return !camera.port && !camera.distortion;
}

// The side file (io/openmvs/dmap.h) of a foreign map is ignored, because it may belong to an older
// map of this program.
io::DmapSide side_to_read(DmapOrigin origin) {
  return origin == DmapOrigin::foreign ? io::DmapSide::ignored : io::DmapSide::used;
}

// The largest distance [px] between the images of the same points in the map's camera and in the
// scene's camera, at the map's resolution. The points are those that the map's corners and centre
// see at the middle of its depth range.
double largest_shift(const DepthMap& map, const CameraModel& model, const Pose& pose) {
  const double w = map.camera.width - 1, h = map.camera.height - 1;
  const Eigen::Vector2d pixels[] = {{0, 0}, {w, 0}, {0, h}, {w, h}, {w / 2, h / 2}};
  const auto near = static_cast<double>(map.min_depth), far = static_cast<double>(map.max_depth);
  const double depth = near > 0 ? std::sqrt(near * far) : far / 2;
  const CameraVariant<double> of_map = make_camera<double>(map.camera);
  const CameraVariant<double> of_scene = make_camera<double>(model);
  double largest = 0;
  for (const Eigen::Vector2d& pixel : pixels) {
    const Eigen::Vector3d point = map.pose.to_world(
        std::visit([&](const auto& camera) { return camera.ray(pixel).at(depth); }, of_map));
    const auto seen = std::visit(
        [&](const auto& camera) { return camera.project(pose.to_camera(point)); }, of_scene);
    if (!seen.visible) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, (seen.pixel - pixel).norm());
  }
  return largest;
}

// The image's camera at the resolution of its map. Error unless the map belongs to this camera.
CameraModel camera_of_map(const Project& project, std::size_t image, DmapOrigin origin,
                          const Context& context) {
  const std::string file = depth_map_path(project, image).string();
  const SceneImage& scene_image = project.scene.images[image];
  if (origin == DmapOrigin::damaged)
    fail_in(file,
            "the depth map or its side file is damaged: remove both files to fuse the other depth "
            "maps");
  if (origin == DmapOrigin::foreign && !is_plain_pinhole(scene_image.camera))
    fail_in(file,
            "is the depth map of a pinhole camera, but image {} has a port or a distorted lens",
            scene_image.path);
  const DepthMap map = io::read_dmap_header(file, side_to_read(origin), context);
  const cv::Size size(map.camera.width, map.camera.height);
  if (!same_shape(size, {scene_image.camera.width, scene_image.camera.height}))
    fail_in(file, "is {}x{}, but the camera of image {} is {}x{}", size.width, size.height,
            scene_image.path, scene_image.camera.width, scene_image.camera.height);
  CameraModel camera = scene_image.camera.resized(size.width, size.height);
  constexpr double kMostPixels = 1;
  if (const double shift = largest_shift(map, camera, scene_image.pose); !(shift < kMostPixels))
    fail_in(file,
            "its camera projects the scene {:.1f} px away from the camera of image {}: the depth "
            "map was made with other poses or intrinsics",
            shift, scene_image.path);
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

ExistingMaps find_existing_maps(const Project& project, bool make_maps, const Context& context) {
  ExistingMaps maps{std::vector<io::DmapStatus>(project.scene.images.size()), !make_maps};
  // One map at a time: each is read completely, and the memory plan does not exist yet.
  for (const std::size_t image : project.part)
    maps.states[image] = io::dmap_status(depth_map_path(project, image), context);
  return maps;
}

DepthMap read_final_map(const Project& project, const ExistingMaps& maps, std::size_t image,
                        const cv::Mat1b& mask, const Context& context) {
  const auto side = maps.are_final ? side_to_read(maps.states[image].origin) : io::DmapSide::used;
  DepthMap map = io::read_dmap(depth_map_path(project, image), side, context).map;
  if (maps.are_final && !mask.empty()) leave_out(mask, map);
  if (cv::countNonZero(map.normal.reshape(1)) == 0) map.normal.release();
  return map;
}

std::string final_made_from(const Project& project, const MatchOptions& options) {
  return mark_of_stage(project.fingerprint, stage_names(options).back());
}

bool are_complete(const Project& project, const MatchOptions& options, const ExistingMaps& maps) {
  const std::string wanted = final_made_from(project, options);
  return std::ranges::all_of(project.references, [&](std::size_t image) {
    return maps.states[image].is_ours_from(wanted);
  });
}

void require_final_maps(const Project& project, const MatchOptions& options,
                        const ExistingMaps& maps) {
  const std::string wanted = final_made_from(project, options);
  for (const std::size_t image : project.references) {
    const io::DmapStatus& map = maps.states[image];
    if (map.is_ours_from(wanted)) continue;
    const char* fault = map.origin == DmapOrigin::none      ? "does not exist"
                        : map.origin == DmapOrigin::damaged ? "is damaged"
                        : map.origin == DmapOrigin::foreign
                            ? "was written by another program"
                            : "was made from other input or with other options";
    fail_in(depth_map_path(project, image),
            "the depth map {}, and {} makes no depth maps: make all depth maps first, in a run "
            "without it",
            fault, setting("tile"));
  }
}

void check_overwriting(const Project& project, bool overwrite, const ExistingMaps& maps,
                       const Context& context) {
  std::vector<std::size_t> foreign;
  for (const std::size_t image : project.part) {
    if (maps.states[image].origin == DmapOrigin::foreign) foreign.push_back(image);
    if (maps.states[image].origin == DmapOrigin::damaged)
      context.warning(
          "{}: the depth map or its side file is damaged; the depth map is computed again",
          depth_map_path(project, image).string());
  }
  if (foreign.empty()) return;
  const std::string file = depth_map_path(project, foreign.front()).string();
  if (overwrite) {
    context.info("{} and {} other depth maps of other programs are overwritten", file,
                 foreign.size() - 1);
    return;
  }
  const bool fusable = std::ranges::all_of(foreign, [&](std::size_t image) {
    return is_plain_pinhole(project.scene.images[image].camera);
  });
  fail_in(file,
          "was written by another program ({} of {} depth maps were): {}move it away, or give {}",
          foreign.size(), project.part.size(),
          fusable ? "fuse the existing depth maps (" + setting("make_maps false") + "), "
                  : "it counts as the depth map of a pinhole camera: ",
          setting("overwrite_dmaps true"));
}

void keep_images_with_maps(Project& project, const ExistingMaps& maps, const Context& context) {
  std::vector<std::size_t> kept;
  std::filesystem::path missing;  // the first missing map
  std::size_t foreign = 0;
  for (const std::size_t image : project.references) {
    const DmapOrigin origin = maps.states[image].origin;
    if (origin == DmapOrigin::none) {
      context.info("{}: has no depth map, left out", project.scene.images[image].path);
      if (missing.empty()) missing = depth_map_path(project, image);
      continue;
    }
    project.views[image].camera = camera_of_map(project, image, origin, context);
    foreign += origin == DmapOrigin::foreign ? 1 : 0;
    kept.push_back(image);
  }
  if (kept.empty())
    fail("{}: no depth map found: {} does not exist", setting("make_maps false"),
         depth_map_path(project, project.references.front()).string());
  const std::string line = fmt::format("{} of {} images have a depth map, {} by other programs",
                                       kept.size(), project.references.size(), foreign);
  if (kept.size() < project.references.size())
    context.warning("{}; {}, for example, does not exist", line, missing.string());
  else
    context.info("{}", line);
  project.references = project.part = std::move(kept);
}

}  // namespace axial::densify
