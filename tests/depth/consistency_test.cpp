// SPDX-License-Identifier: GPL-3.0-or-later
// Compares the first-order forward-backward error with the exact projection.
#include "depth/consistency.h"

#include <gtest/gtest.h>

#include <random>

#include "depth/patch/reference_patch.h"
#include "refractive/flat_port_camera.h"

namespace axial::depth {
namespace {

refractive::FlatPortCamera<double> camera() {
  refractive::FlatPort<double> port;
  port.normal = Eigen::Vector3d(0.05, -0.03, 1).normalized();
  port.distance = 0.03;
  port.thickness = 0.02;
  port.n_glass = 1.5;
  port.n_water = 1.333;
  return {{800, 820, 511.5, 383.5}, port, 1024, 768};
}

// Shifts of up to about 3 px across the ray, where the term of the cost reaches its limit, and of
// up to kSameSurface along the ray.
TEST(ShiftInPixels, AgreesWithTheExactProjection) {
  const auto seen_by = camera();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int k = 0; k < 2000; ++k) {
    const Eigen::Vector2d pixel(511.5 + 500 * unit(random), 383.5 + 370 * unit(random));
    const double depth = 1.5 + unit(random);
    refractive::AxialRayJacobian<double> jacobian;
    const auto ray = seen_by.ray(pixel, jacobian);
    const Eigen::Vector3d across = 0.002 * depth * Eigen::Vector3d(unit(random), unit(random), 0);
    const Eigen::Vector3d shift = across + kSameSurface * depth * unit(random) * ray.direction;
    const auto moved = seen_by.project(ray.at(depth) + shift);
    const double exact = (moved.pixel - pixel).norm();
    // The relative error is half the shift divided by the focal length; a port doubles it.
    const double relative = exact / seen_by.lens().fx;
    EXPECT_NEAR(shift_in_pixels(ray, jacobian, depth, shift), exact, relative * exact + 1e-9);
  }
}

TEST(InconsistencyTerm, IsCappedAndGrowsWithTheError) {
  EXPECT_EQ(inconsistency_term(0.0, 4.0), 0);
  EXPECT_NEAR(inconsistency_term(1.0, 4.0), std::sqrt(3.0), 1e-12);
  EXPECT_EQ(inconsistency_term(100.0, 4.0), 4);
}

}  // namespace
}  // namespace axial::depth
