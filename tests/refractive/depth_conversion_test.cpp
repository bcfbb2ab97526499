// SPDX-License-Identifier: GPL-3.0-or-later
#include "refractive/depth_conversion.h"

#include <gtest/gtest.h>

#include "refractive/pinhole_camera.h"
#include "refractive/views.h"

namespace axial::refractive::testing {
namespace {

TEST(DepthConversion, GoesThereAndBack) {
  Random random(41);
  for (int k = 0; k < 5000; ++k) {
    const View view = random_view(random);
    const AxialRay<double> ray = view.camera<double>().ray(random_pixel(random, view));
    const double distance = random.log_uniform(0.3, 10);
    const Vector3<double> X = ray.origin + distance * ray.direction;
    EXPECT_NEAR(range_from_distance(ray, distance), X.norm(), 1e-14);
    EXPECT_NEAR(z_depth_from_distance(ray, distance), X.z(), 1e-14);
    // A few roundings of numbers up to 10, divided by a cosine of at least 0.3.
    EXPECT_NEAR(distance_from_range(ray, X.norm()), distance, 1e-13);
    EXPECT_NEAR(distance_from_z_depth(ray, X.z()), distance, 1e-13);
  }
}

TEST(DepthConversion, KeepsSinglePrecision) {
  Random random(42);
  for (int k = 0; k < 5000; ++k) {
    const View view = random_view(random);
    const AxialRay<float> ray = view.camera<float>().ray({100, 200});
    const auto distance = static_cast<float>(random.log_uniform(0.3, 10));
    EXPECT_NEAR(distance_from_range(ray, range_from_distance(ray, distance)) / distance, 1, 1e-6);
    EXPECT_NEAR(distance_from_z_depth(ray, z_depth_from_distance(ray, distance)) / distance, 1,
                1e-6);
  }
}

TEST(DepthConversion, DistanceIsRangeWithoutAPort) {
  const PinholeCamera<double> camera(lens_with_fov(80, 640, 480));
  const AxialRay<double> ray = camera.ray({13, 400});
  EXPECT_NEAR(range_from_distance(ray, 2.5), 2.5, 1e-15);
  EXPECT_NEAR(distance_from_range(ray, 2.5), 2.5, 1e-15);
}

TEST(DepthConversion, ARangeTooSmallForTheRayGivesItsClosestPoint) {
  const AxialRay<double> ray{{0, 0, -0.01}, Vector3<double>(1, 0, 1).normalized()};
  const double distance = distance_from_range(ray, 0.001);
  EXPECT_NEAR(ray.at(distance).dot(ray.direction), 0, 1e-15);
}

}  // namespace
}  // namespace axial::refractive::testing
