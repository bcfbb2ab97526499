// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud/colors.h"

#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/parallel.h"
#include "scene/camera_model.h"

namespace axial::cloud {
namespace {

constexpr Rgb kWhite{255, 255, 255};

std::uint32_t nearest_view(const PointCloud& cloud, std::size_t point, const Scene& scene) {
  const Eigen::Vector3d X = cloud.positions[point].cast<double>();
  std::uint32_t best = kNoId;
  double least = std::numeric_limits<double>::infinity();
  for (const std::uint32_t image : cloud.views_of(point)) {
    if (image >= scene.images.size()) {
      fail("point {}: refers to image {}, but there are {} images", point, image,
           scene.images.size());
    }
    const double depth = scene.images[image].pose.to_camera(X).z();
    if (depth > 0 && depth < least) {
      least = depth;
      best = image;
    }
  }
  return best;
}

Rgb sample(const cv::Mat3b& image, const Eigen::Vector2d& pixel) {
  const bool inside = pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() <= image.cols - 1 &&
                      pixel.y() <= image.rows - 1;
  if (!inside) return kWhite;
  const int x = static_cast<int>(pixel.x()), y = static_cast<int>(pixel.y());
  const int x1 = std::min(x + 1, image.cols - 1), y1 = std::min(y + 1, image.rows - 1);
  const double a = pixel.x() - x, b = pixel.y() - y;
  Rgb color;
  for (int c = 0; c < 3; ++c) {
    const double value = (1 - b) * ((1 - a) * image(y, x)[c] + a * image(y, x1)[c]) +
                         b * ((1 - a) * image(y1, x)[c] + a * image(y1, x1)[c]);
    color[static_cast<std::size_t>(2 - c)] = static_cast<std::uint8_t>(value + 0.5);
  }
  return color;
}

}  // namespace

void estimate_colors(PointCloud& cloud, const Scene& scene,
                     const std::function<cv::Mat3b(std::size_t image)>& load_color) {
  if (cloud.view_begin.size() != cloud.size() + 1) fail("the cloud has no views to colour it from");
  cloud.colors.assign(cloud.size(), kWhite);
  std::vector<std::vector<std::size_t>> points_of(scene.images.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const std::uint32_t image = nearest_view(cloud, i, scene);
    if (image != kNoId) points_of[image].push_back(i);
  }
  for (std::size_t i = 0; i < scene.images.size(); ++i) {
    const std::vector<std::size_t>& points = points_of[i];
    if (points.empty()) continue;
    const cv::Mat3b image = load_color(i);
    if (image.empty()) fail_in(scene.images[i].path, "the image is empty");
    const Pose& pose = scene.images[i].pose;
    std::visit(
        [&](const auto& camera) {
          parallel_for(
              points.size(),
              [&](std::size_t k) {
                const auto seen =
                    camera.project(pose.to_camera(cloud.positions[points[k]].cast<double>()));
                if (seen.visible) cloud.colors[points[k]] = sample(image, seen.pixel);
              },
              kPointGrain);
        },
        make_camera<double>(scene.images[i].camera.resized(image.cols, image.rows)));
  }
}

}  // namespace axial::cloud
