// SPDX-License-Identifier: GPL-3.0-or-later
// Judges a cloud by photographs that had no part in it: of the points that two held-out images see,
// how many look the same in both? Usage:
//
//     held_out_check SCENE.mvs CLOUD.ply IMAGE_A IMAGE_B RESOLUTION_LEVEL
//
// SCENE holds all images; IMAGE_A and IMAGE_B are the names of the two that the cloud was made
// without. A point counts as seen where it is the front-most of the cloud within 1 % of depth and
// its normal faces both cameras; it agrees if the ZNCC of the window around it in A with the window
// carried into B over its tangent plane is above 0.6. Prints "seen N agree M fraction F angle D",
// D the median angle in degrees at which the two see a point: the wider, the less a plane can stand
// for the surface under a window, whatever the cloud.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iostream>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "base/error.h"
#include "base/order_statistics.h"
#include "check_program.h"
#include "depth/sweep/matcher.h"
#include "io/cameras/housing.h"
#include "io/cameras/lenses.h"
#include "io/images/image.h"
#include "io/openmvs/mvs.h"
#include "io/ply/ply.h"
#include "scene/resolution.h"

namespace {

using namespace axial;
using Camera = refractive::PinholeCamera<float>;

struct View {
  CameraModel model;
  Pose pose;
  cv::Mat1b grey;
  cv::Mat1f nearest;  // z-buffer of the cloud, 3x3 splats
};

View load_view(const Scene& scene, const std::string& name, unsigned level) {
  for (const SceneImage& image : scene.images) {
    if (std::filesystem::path(image.path).filename() != name) continue;
    const cv::Mat3b color = io::read_color_image(image.path);
    const cv::Size size = working_size(color.cols, color.rows, {level, 1, 1 << 16});
    View view{image.camera.resized(size.width, size.height), image.pose, {}, {}};
    cv::cvtColor(resized_image(color, size), view.grey, cv::COLOR_BGR2GRAY);
    view.nearest = cv::Mat1f(size, std::numeric_limits<float>::max());
    return view;
  }
  fail("{}: no such image in the scene", name);
}

struct ProjectedPoint {
  bool inside = false;
  int x = 0, y = 0;
  float depth = 0;
};

ProjectedPoint project(const View& view, const Camera& camera, const Eigen::Vector3f& point) {
  const Eigen::Vector3f in_camera = view.pose.to_camera(point.cast<double>()).cast<float>();
  const auto image = camera.project(in_camera);
  ProjectedPoint projected{false, cvRound(image.pixel.x()), cvRound(image.pixel.y()),
                           in_camera.norm()};
  projected.inside = image.visible && depth::window_inside(projected.x, projected.y,
                                                           view.grey.cols - 2, view.grey.rows - 2);
  return projected;
}

void splat(View& view, const Camera& camera, const PointCloud& cloud) {
  for (const Eigen::Vector3f& point : cloud.positions) {
    const ProjectedPoint projected = project(view, camera, point);
    if (!projected.inside) continue;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        float& nearest = view.nearest(projected.y + dy, projected.x + dx);
        nearest = std::min(nearest, projected.depth);
      }
  }
}

bool in_front(const View& view, const ProjectedPoint& projected) {
  return projected.inside && projected.depth < 1.01f * view.nearest(projected.y, projected.x);
}

int run(int, char** argv) {
  const Scene scene = io::read_mvs(argv[1], std::filesystem::path(argv[1]).parent_path());
  for (const auto& beside : {io::housing_beside(argv[1]), io::lenses_beside(argv[1])})
    if (std::filesystem::exists(beside)) fail("{}: expected a scene of pinholes", beside.string());
  const PointCloud cloud = io::read_cloud_ply(argv[2]);
  if (cloud.normals.size() != cloud.size()) fail("{}: has no normals", argv[2]);
  const auto level = static_cast<unsigned>(std::stoul(argv[5]));
  View a = load_view(scene, argv[3], level);
  View b = load_view(scene, argv[4], level);
  const Camera camera_a(a.model.lens.cast<float>());
  const Camera camera_b(b.model.lens.cast<float>());
  splat(a, camera_a, cloud);
  splat(b, camera_b, cloud);

  const depth::QuadImage quad(b.grey);
  const depth::Matcher<Camera, depth::AffineWarp> matcher(
      a.grey, camera_a, {{camera_b, depth::RelativePose(a.pose, b.pose), &quad, nullptr}}, {});
  std::vector<float> angles;  // of the points seen [degrees]
  std::size_t agree = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f& point = cloud.positions[i];
    const ProjectedPoint in_a = project(a, camera_a, point);
    if (!in_front(a, in_a) || !in_front(b, project(b, camera_b, point))) continue;
    const Eigen::Vector3f x = a.pose.to_camera(point.cast<double>()).cast<float>();
    const Eigen::Vector3f normal = (a.pose.rotation.cast<float>() * cloud.normals[i]).normalized();
    const Eigen::Vector3f from_a = (point - a.pose.centre.cast<float>()).normalized();
    const Eigen::Vector3f from_b = (point - b.pose.centre.cast<float>()).normalized();
    const depth::ReferencePixel pixel = matcher.pixels().prepare(in_a.x, in_a.y);
    const float along = normal.dot(pixel.ray.direction);
    if (!(along < -0.2f) || !(cloud.normals[i].dot(from_b) < -0.2f)) continue;
    const depth::PlaneHypothesis plane{normal.dot(x) / along, normal};
    constexpr std::array<depth::ScorePair, 1> kPair{{{0, 0}}};
    std::array<depth::PlaneScore, 1> score;
    matcher.score(pixel, {&plane, 1}, kPair, {}, score);
    angles.push_back(std::acos(std::clamp(from_a.dot(from_b), -1.0f, 1.0f)) * 180.0f /
                     std::numbers::pi_v<float>);
    if (score[0].cost < 0.4f) ++agree;
  }
  const auto seen = static_cast<double>(angles.size());
  std::cout << fmt::format("seen {} agree {} fraction {:.4f} angle {:.0f}\n", angles.size(), agree,
                           angles.empty() ? 0.0 : static_cast<double>(agree) / seen,
                           upper_median(angles));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return axial::check_program(
      argc, argv, 5, 5, "held_out_check SCENE.mvs CLOUD.ply IMAGE_A IMAGE_B RESOLUTION_LEVEL", run);
}
