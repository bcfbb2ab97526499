// SPDX-License-Identifier: GPL-3.0-or-later
#include "survey/memory_survey.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.h"

namespace axial::survey {
namespace {

void require_above_zero(double value, const std::string& field) {
  if (!(value > 0) || !std::isfinite(value)) fail("{} {}: must be above 0", field, value);
}

void check_pose(const Pose& pose, const std::string& field) {
  const Eigen::Matrix3d& r = pose.rotation;
  const double deviation = (r * r.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(deviation <= 1e-3) || r.determinant() < 0) fail("{}.rotation is not a rotation", field);
  if (!pose.centre.allFinite()) fail("{}.centre contains a value that is not finite", field);
}

void check_points(const Scene& scene) {
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    if (!scene.points[i].position.allFinite())
      fail("points[{}].position contains a value that is not finite", i);
    for (const SparseView& view : scene.points[i].views)
      if (view.image >= scene.images.size())
        fail("points[{}] has a view of image {}, but the scene has {} images", i, view.image,
             scene.images.size());
  }
}

}  // namespace

void check_camera(const CameraModel& camera, const std::string& field) {
  require_above_zero(camera.width, field + ".width");
  require_above_zero(camera.height, field + ".height");
  require_above_zero(camera.lens.fx, field + ".lens.fx");
  require_above_zero(camera.lens.fy, field + ".lens.fy");
  if (!std::isfinite(camera.lens.cx) || !std::isfinite(camera.lens.cy))
    fail("{}.lens has the principal point {} {}", field, camera.lens.cx, camera.lens.cy);
  if (camera.port) io::check_port(*camera.port, field + ".port");
}

void check(const MemorySurvey& survey) {
  if (!survey.read) fail("read: is empty, so that no photograph can be read");
  const std::vector<SceneImage>& images = survey.scene.images;
  if (std::ranges::none_of(images, &SceneImage::calibrated))
    fail("images: none of {} images is calibrated", images.size());
  std::set<std::string> paths;
  for (std::size_t i = 0; i < images.size(); ++i) {
    if (!images[i].calibrated) continue;
    const std::string field = fmt::format("images[{}]", i);
    if (images[i].path.empty() || !paths.insert(images[i].path).second)
      fail("{}.path '{}': must be a path that no other image has", field, images[i].path);
    check_camera(images[i].camera, field + ".camera");
    check_pose(images[i].pose, field + ".pose");
  }
  check_points(survey.scene);
}

std::optional<io::Housing> housing_of(Scene& scene) {
  io::Housing housing;
  std::vector<refractive::Port<double>> ports;
  for (SceneImage& image : scene.images) {
    image.port_name.clear();
    if (!image.calibrated || !image.camera.port) continue;
    const auto same = std::ranges::find(ports, *image.camera.port);
    image.port_name = fmt::format("port_{}", same - ports.begin() + 1);
    housing.images[image.path] = image.port_name;
    if (same != ports.end()) continue;
    housing.ports[image.port_name] = io::to_housing_port(*image.camera.port);
    ports.push_back(*image.camera.port);
  }
  if (ports.empty()) return {};
  return housing;
}

io::SceneWithCameras scene_of(const MemorySurvey& survey) {
  check(survey);
  io::SceneWithCameras result{survey.scene, frame_of(survey.scene), {}};
  for (SceneImage& image : result.scene.images) {
    image.mask_path.clear();
    image.neighbours.clear();
  }
  enter(result.frame, result.scene);
  result.housing = housing_of(result.scene);
  return result;
}

io::ImageHeader header_of(const MemorySurvey& survey, std::size_t image) {
  const CameraModel& camera = survey.scene.images[image].camera;
  io::ImageHeader header;
  header.size = {camera.width, camera.height};
  header.alpha = survey.has_masks;
  return header;
}

io::Photograph photograph_of(const MemorySurvey& survey, std::size_t image) {
  io::Photograph photograph = survey.read(image);
  const cv::Mat &pixels = photograph.pixels, &opaque = photograph.opaque;
  const SceneImage& of = survey.scene.images[image];
  const cv::Size size(of.camera.width, of.camera.height);
  if (pixels.type() != CV_8UC3 || pixels.size() != size)
    fail_in(of.path, "the photograph is not of {} x {} pixels with three channels of 8 bits",
            size.width, size.height);
  if (!opaque.empty() && (!survey.has_masks || opaque.size() != size))
    fail_in(of.path, "the mask has {} x {} pixels, {}", opaque.cols, opaque.rows,
            survey.has_masks ? "the photograph another number" : "but has_masks is false");
  return photograph;
}

}  // namespace axial::survey
