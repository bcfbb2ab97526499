// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/openmvs/mvs.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "base/atomic_file.h"
#include "base/error.h"
#include "cameras/private/checked_rotation.h"
#include "io/images/image.h"
#include "io/openmvs/mvs_counts.h"
#include "openmvs/private/image_folders.h"
#include "openmvs/private/mvs_format.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kLargestSide = 1'000'000;

Eigen::Vector3d checked_centre(const Eigen::Vector3d& centre, const std::string& where) {
  if (!centre.allFinite()) fail("{} contains a value that is not finite", where);
  return centre;
}

// Camera on platform: R = R_cam R_pose, C = R_pose^T C_cam + C_pose.
Pose compose(const MvsPose& camera, const MvsPose& platform, const std::string& where) {
  const Eigen::Matrix3d r_cam = checked_rotation(camera.rotation, where + " camera R");
  const Eigen::Matrix3d r_pose = checked_rotation(platform.rotation, where + " pose R");
  const Eigen::Vector3d c_cam = checked_centre(camera.centre, where + " camera C");
  const Eigen::Vector3d c_pose = checked_centre(platform.centre, where + " pose C");
  const Eigen::Vector3d centre = r_pose.transpose() * c_cam + c_pose;
  return {r_cam * r_pose, checked_centre(centre, where + " C of the camera on its platform")};
}

void check_intrinsics(const Eigen::Matrix3d& k, const std::string& where) {
  if (!k.allFinite()) fail("{} K contains a value that is not finite", where);
  if (!(k(0, 0) > 0) || !(k(1, 1) > 0))
    fail("{} K has the focal lengths {} and {}, which must be positive", where, k(0, 0), k(1, 1));
  if (std::abs(k(0, 1)) > 1e-9 * k(0, 0))
    fail("{} K has the skew {}: only pixels without skew are supported", where, k(0, 1));
  if (k(1, 0) != 0 || k(2, 0) != 0 || k(2, 1) != 0 || k(2, 2) != 1)
    fail(
        "{} K is not a calibration matrix: the values below its diagonal are {}, {}, {}, the value "
        "in its corner is {}",
        where, k(1, 0), k(2, 0), k(2, 1), k(2, 2));
}

// The principal point of a normalised K on one axis [px]. S is the longer side (docs/formats.md).
double principal_point(double normalised, bool from_corner, double S) {
  return from_corner ? normalised * S : (normalised + 0.5) * S - 0.5;
}

CameraModel denormalised(const Eigen::Matrix3d& k, cv::Size size) {
  CameraModel model;
  model.width = size.width;
  model.height = size.height;
  const double S = std::max(size.width, size.height);
  const double on_long_axis = size.width >= size.height ? k(0, 2) : k(1, 2);
  const bool from_corner = on_long_axis >= 0.25;
  model.lens = {k(0, 0) * S, k(1, 1) * S, principal_point(k(0, 2), from_corner, S),
                principal_point(k(1, 2), from_corner, S)};
  if (k(0, 2) == 0 && k(1, 2) == 0) {
    model.lens.cx = (size.width - 1) / 2.0;
    model.lens.cy = (size.height - 1) / 2.0;
  }
  return model;
}

CameraModel camera_model(const MvsCamera& camera, const fs::path& image, const std::string& where) {
  check_intrinsics(camera.k, where);
  if ((camera.width == 0) != (camera.height == 0) || camera.width > kLargestSide ||
      camera.height > kLargestSide)
    fail("{} camera has the size {}x{}", where, camera.width, camera.height);
  if (camera.width == 0) return denormalised(camera.k, read_image_size(image));
  CameraModel model;
  model.width = static_cast<int>(camera.width);
  model.height = static_cast<int>(camera.height);
  model.lens = {camera.k(0, 0), camera.k(1, 1), camera.k(0, 2), camera.k(1, 2)};
  return model;
}

// The name of a file, with '/' between its folders.
std::string with_slashes(std::string name, const std::string& where) {
  if (name.find('\0') != std::string::npos) fail("{} contains a NUL", where);
  std::ranges::replace(name, '\\', '/');
  return name;
}

// The paths of the files of each image.
struct ImagePaths {
  std::vector<std::string> images, masks;
};

ImagePaths find_paths(const MvsFile& mvs, const fs::path& working_folder, const fs::path& scene,
                      const Context& context) {
  ImagePaths names;
  for (std::size_t i = 0; i < mvs.images.size(); ++i) {
    const std::string where = fmt::format("{}: images[{}]", scene.string(), i);
    if (mvs.images[i].name.empty()) fail("{}.name is empty", where);
    names.images.push_back(with_slashes(mvs.images[i].name, where + ".name"));
    names.masks.push_back(with_slashes(mvs.images[i].mask_name, where + ".maskName"));
  }
  return {find_files_of_scene(working_folder, scene, names.images, "images", context),
          find_files_of_scene(working_folder, scene, names.masks, "masks", context)};
}

template <class T>
const T& element(const std::vector<T>& items, std::uint32_t index, const char* what,
                 const std::string& where) {
  if (index >= items.size())
    fail("{}.{} is {}, but there are {}", where, what, index, items.size());
  return items[index];
}

void set_camera_and_pose(const MvsImage& record, const MvsFile& mvs, const std::string& where,
                         SceneImage& image) {
  image.calibrated = record.pose != kNoId;
  if (!image.calibrated && record.platform == kNoId) return;
  const MvsPlatform& platform = element(mvs.platforms, record.platform, "platformID", where);
  const MvsCamera& camera = element(platform.cameras, record.camera, "cameraID", where);
  if (!image.calibrated) return;
  const MvsPose& pose = element(platform.poses, record.pose, "poseID", where);
  image.camera = camera_model(camera, image.path, where);
  image.pose = compose(camera.on_platform, pose, where);
}

void check_scores(const MvsImage& record, std::size_t index, std::size_t images,
                  const std::string& where) {
  for (const float depth : {record.min_depth, record.average_depth, record.max_depth})
    if (!std::isfinite(depth)) fail("{} has a depth statistic of {}", where, depth);
  for (const ViewScore& score : record.view_scores) {
    if (score.image >= images || score.image == index)
      fail(
          "{}.viewScores refers to image {}, but there are {}, and an image cannot be its own "
          "neighbour",
          where, score.image, images);
    if (!std::isfinite(score.scale + score.angle + score.area + score.score))
      fail("{}.viewScores for image {} contains a value that is not finite", where, score.image);
  }
}

SceneImage scene_image(const MvsFile& mvs, std::size_t index, const ImagePaths& paths,
                       const std::string& file) {
  const MvsImage& record = mvs.images[index];
  const std::string where = fmt::format("{}: images[{}]", file, index);
  SceneImage image;
  image.path = paths.images[index];
  image.mask_path = paths.masks[index];
  image.id = record.id == kNoId ? static_cast<std::uint32_t>(index) : record.id;
  set_camera_and_pose(record, mvs, where, image);
  check_scores(record, index, mvs.images.size(), where);
  image.min_depth = record.min_depth;
  image.average_depth = record.average_depth;
  image.max_depth = record.max_depth;
  image.neighbours = record.view_scores;
  return image;
}

void check_points(MvsFile& mvs, const std::string& file) {
  for (std::size_t i = 0; i < mvs.points.size(); ++i) {
    SparsePoint& point = mvs.points[i];
    if (!point.position.allFinite())
      fail_in(file, "vertices[{}] is at ({}, {}, {})", i, point.position.x(), point.position.y(),
              point.position.z());
    for (const SparseView& view : point.views) {
      if (view.image >= mvs.images.size())
        fail_in(file, "vertices[{}].views refers to image {}, but there are {}", i, view.image,
                mvs.images.size());
      if (!std::isfinite(view.confidence))
        fail_in(file, "vertices[{}].views has the confidence {}", i, view.confidence);
    }
    std::ranges::stable_sort(point.views, {}, &SparseView::image);
  }
  for (std::size_t i = 0; i < mvs.normals.size(); ++i)
    if (!mvs.normals[i].allFinite()) fail_in(file, "verticesNormal[{}] is not finite", i);
  const auto require_length = [&](std::size_t length, const char* field) {
    if (length != 0 && length != mvs.points.size())
      fail_in(file, "{} has {} elements, but there are {} vertices", field, length,
              mvs.points.size());
  };
  require_length(mvs.normals.size(), "verticesNormal");
  require_length(mvs.colors.size(), "verticesColor");
}

// The centre is a point in the world, and the extents run along the axes of the box.
std::optional<OrientedBox> region_of(const MvsBox& box, const std::string& file) {
  if (!(box.min.array() < box.max.array()).all()) return {};
  OrientedBox region{box.rotation, (box.min + box.max) / 2, (box.max - box.min) / 2};
  if (!region.centre.allFinite() || !region.half_extent.allFinite())
    fail_in(file, "obb has an extent that is not finite");
  // The box is symmetric, so a reflection describes the same box as a rotation.
  const double sign = region.rotation.allFinite() && region.rotation.determinant() < 0 ? -1 : 1;
  region.rotation = sign * checked_rotation(sign * region.rotation, file + ": obb rot");
  return region;
}

// There are two conventions for the principal point, and the file does not name the one it uses.
void warn_of_normalised_cameras(const Scene& scene, const MvsFile& mvs, const std::string& file,
                                const Context& context) {
  for (std::size_t i = 0; i < scene.images.size(); ++i) {
    const SceneImage& image = scene.images[i];
    if (!image.calibrated) continue;
    const MvsImage& record = mvs.images[i];
    if (mvs.platforms[record.platform].cameras[record.camera].width > 0) continue;
    context.warning(
        "{}: cameras are stored without a resolution; the principal point of {} is taken "
        "to be ({:.2f}, {:.2f}) of {}x{} pixels",
        file, image.path, image.camera.lens.cx, image.camera.lens.cy, image.camera.width,
        image.camera.height);
    return;
  }
}

void require_unique_ids(const Scene& scene, const std::string& file) {
  std::unordered_set<std::uint32_t> ids;
  for (const SceneImage& image : scene.images)
    if (!ids.insert(image.id).second)
      fail_in(file, "two images have the ID {}, which names depth maps", image.id);
}

std::string stored_path(const std::string& path, const fs::path& working_folder) {
  if (path.empty()) return {};
  const fs::path normal = fs::path(path).lexically_normal();
  const fs::path relative = normal.lexically_relative(working_folder);
  const bool below = !relative.empty() && *relative.begin() != "..";
  return below ? relative.generic_string() : normal.generic_string();
}

bool same_camera(const MvsCamera& a, const MvsCamera& b) {
  return a.width == b.width && a.height == b.height && a.k == b.k;
}

// The principal point is relative to the centre of the square of side S that encloses the image.
// This is the inverse of `denormalised`.
MvsCamera normalised_record(const CameraModel& model) {
  const double S = std::max(model.width, model.height);
  const refractive::PinholeLens<double>& lens = model.lens;
  MvsCamera camera;
  camera.k << lens.fx / S, 0, (lens.cx + 0.5) / S - 0.5, 0, lens.fy / S, (lens.cy + 0.5) / S - 0.5,
      0, 0, 1;
  const refractive::PinholeLens<double> read =
      denormalised(camera.k, {model.width, model.height}).lens;
  if (std::hypot(read.cx - lens.cx, read.cy - lens.cy) > 1e-6)
    fail(
        "Normalised intrinsics: a principal point at ({}, {}) of {}x{} pixels would be read as "
        "another point",
        lens.cx, lens.cy, model.width, model.height);
  return camera;
}

MvsCamera camera_record(const CameraModel& model, MvsIntrinsics intrinsics) {
  if (intrinsics == MvsIntrinsics::normalised) return normalised_record(model);
  MvsCamera camera;
  camera.width = static_cast<std::uint32_t>(model.width);
  camera.height = static_cast<std::uint32_t>(model.height);
  camera.k << model.lens.fx, 0, model.lens.cx, 0, model.lens.fy, model.lens.cy, 0, 0, 1;
  return camera;
}

// Makes one platform for each distinct camera, with the camera at its origin.
void add_camera_and_pose(const SceneImage& image, MvsIntrinsics intrinsics, MvsFile& mvs,
                         MvsImage& record) {
  if (!image.calibrated) return;
  const MvsCamera camera = camera_record(image.camera, intrinsics);
  auto platform = std::ranges::find_if(mvs.platforms, [&](const MvsPlatform& known) {
    return same_camera(known.cameras[0], camera);
  });
  if (platform == mvs.platforms.end())
    platform = mvs.platforms.insert(platform, MvsPlatform{{camera}, {}});
  record.platform = static_cast<std::uint32_t>(platform - mvs.platforms.begin());
  record.camera = 0;
  record.pose = static_cast<std::uint32_t>(platform->poses.size());
  platform->poses.push_back({image.pose.rotation, image.pose.centre});
}

MvsImage image_record(const SceneImage& image, const fs::path& working_folder,
                      MvsIntrinsics intrinsics, MvsFile& mvs) {
  MvsImage record;
  record.name = stored_path(image.path, working_folder);
  record.mask_name = stored_path(image.mask_path, working_folder);
  record.id = image.id;
  add_camera_and_pose(image, intrinsics, mvs, record);
  record.min_depth = image.min_depth;
  record.average_depth = image.average_depth;
  record.max_depth = image.max_depth;
  record.view_scores = image.neighbours;
  return record;
}

fs::path absolute_folder(const fs::path& folder) {
  return fs::absolute(folder.empty() ? fs::path(".") : folder).lexically_normal();
}

}  // namespace

Scene read_mvs(const fs::path& path, const fs::path& working_folder, const Context& context) {
  const std::string file = path.string();
  MvsFile mvs = parse_mvs(read_file(path), file);
  if (mvs.platforms.empty()) fail_in(file, "has no platforms");
  if (mvs.images.size() < 2)
    fail_in(file, "has {} images, at least 2 are needed", mvs.images.size());
  check_points(mvs, file);
  Scene scene;
  const ImagePaths paths = find_paths(mvs, absolute_folder(working_folder), path, context);
  for (std::size_t i = 0; i < mvs.images.size(); ++i)
    scene.images.push_back(scene_image(mvs, i, paths, file));
  require_unique_ids(scene, file);
  warn_of_normalised_cameras(scene, mvs, file, context);
  scene.points = std::move(mvs.points);
  scene.point_normals = std::move(mvs.normals);
  scene.point_colors = std::move(mvs.colors);
  scene.region = region_of(mvs.box, file);
  return scene;
}

void write_mvs(const fs::path& path, const Scene& scene, const fs::path& working_folder,
               MvsIntrinsics intrinsics) {
  const std::string file = path.string();
  MvsFile mvs;
  const fs::path base = absolute_folder(working_folder) / "";
  for (const SceneImage& image : scene.images)
    mvs.images.push_back(image_record(image, base, intrinsics, mvs));
  if (mvs.images.size() < 2 || mvs.platforms.empty())
    fail_in(file, "a scene needs two images and a calibrated camera, this scene has {} images",
            mvs.images.size());
  mvs.points = scene.points;
  mvs.normals = scene.point_normals;
  mvs.colors = scene.point_colors;
  check_points(mvs, file);
  if (scene.region)
    mvs.box = {scene.region->rotation, scene.region->centre - scene.region->half_extent,
               scene.region->centre + scene.region->half_extent};
  write_atomically(path, format_mvs(mvs, count_scene(scene).file_bytes));
}

}  // namespace axial::io
