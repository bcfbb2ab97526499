// SPDX-License-Identifier: GPL-3.0-or-later
// Bright dots on a plane are rendered by tracing rays through the port. They must appear where the
// closed form projects their centres.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "refractive/flat_port_camera.h"
#include "simulate/render.h"

namespace axial::simulate {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPlane = 0.8;     // depth of the dots' plane [m]
constexpr double kRadius = 0.006;  // radius of a dot: about three pixels
constexpr int kWindow = 9;         // half the width of the window of a centroid

TriangleMesh plane_mesh() {
  const auto z = static_cast<float>(kPlane);
  const float a = 5;
  return {{{-a, -a, z}, {a, -a, z}, {a, a, z}, {-a, a, z}}, {{0, 2, 1}, {0, 3, 2}}};
}

// Soft edges, so that the centroid hardly depends on the sampling of pixels.
Shader glow(const std::vector<Vector3d>& dots) {
  return [&dots](const SurfacePoint& point) -> Eigen::Vector3f {
    for (const Vector3d& dot : dots) {
      const double s = 1 - (point.position - dot).squaredNorm() / (kRadius * kRadius);
      if (s > 0) return Eigen::Vector3f::Constant(static_cast<float>(s));
    }
    return Eigen::Vector3f::Zero();
  };
}

Vector2d centroid(const cv::Mat3b& image, const Vector2d& near) {
  const int u0 = static_cast<int>(std::lround(near.x()));
  const int v0 = static_cast<int>(std::lround(near.y()));
  Vector2d sum = Vector2d::Zero();
  double weight = 0;
  for (int v = v0 - kWindow; v <= v0 + kWindow; ++v) {
    for (int u = u0 - kWindow; u <= u0 + kWindow; ++u) {
      const double value = image(v, u)[1];
      sum += value * Vector2d(u, v);
      weight += value;
    }
  }
  return weight > 0 ? Vector2d(sum / weight) : Vector2d(-1, -1);
}

// Pixels all over the image, also near the corners, far enough inside for a complete dot.
std::vector<Vector2d> target_pixels(const Lens& lens) {
  std::vector<Vector2d> pixels;
  const double inset = kWindow + 2.3;
  for (int row = 0; row < 5; ++row)
    for (int column = 0; column < 7; ++column)
      pixels.emplace_back(inset + column / 6.0 * (lens.width - 1 - 2 * inset),
                          inset + row / 4.0 * (lens.height - 1 - 2 * inset));
  return pixels;
}

void compare(double tilt_degrees) {
  const Lens lens = make_lens(480, 360, 80);
  const Port port{tilted_normal(tilt_degrees), 0.020, 0.014, 1, 1.52, 1.333};
  const refractive::FlatPortCamera<double> camera(
      {lens.focal, lens.focal, lens.cx, lens.cy},
      {port.normal, port.distance, port.thickness, port.n_air, port.n_glass, port.n_water},
      lens.width, lens.height);
  std::vector<Vector3d> dots;
  for (const Vector2d& pixel : target_pixels(lens)) {
    const auto ray = camera.ray(pixel);
    dots.push_back(ray.at((kPlane - ray.origin.z()) / ray.direction.z()));
  }
  const RayScene scene(plane_mesh());
  const cv::Mat3b image = develop(render_radiance(scene, glow(dots), lens, &port, View{}, 4), 0, 0);

  for (const Vector3d& dot : dots) {
    const auto projected = camera.project(dot);
    ASSERT_TRUE(projected.visible);
    const Vector2d seen = centroid(image, projected.pixel);
    // The required accuracy. The remaining error comes from the size of a dot, over which the
    // projection is not linear.
    EXPECT_LT((seen - projected.pixel).norm(), 0.05)
        << "tilt " << tilt_degrees << ": projected " << projected.pixel.transpose() << ", seen "
        << seen.transpose();
  }
}

TEST(Dots, AppearWhereTheyAreProjectedWithoutTilt) {
  compare(0);
}
TEST(Dots, AppearWhereTheyAreProjectedWithFiveDegreesOfTilt) {
  compare(5);
}

}  // namespace
}  // namespace axial::simulate
