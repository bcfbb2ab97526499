// SPDX-License-Identifier: GPL-3.0-or-later
// The round trip pixel -> ray -> point -> pixel through a flat port, over the range of housings for
// which the project promises accuracy.
#include <gtest/gtest.h>

#include "refractive/views.h"

namespace axial::refractive::testing {
namespace {

template <class T>
double largest_round_trip_error(unsigned seed, int width, int height) {
  Random random(seed);
  double largest = 0;
  int tested = 0;
  for (int k = 0; k < 2000; ++k) {
    const View view = random_view(random, width, height);
    const auto camera = view.camera<T>();
    for (int i = 0; i < 10; ++i) {
      // The first four of ten pixels are corners, where the incidence is largest.
      const Vector2<double> somewhere = random_pixel(random, view);
      const Vector2<double> corner((i & 1) * (width - 1), (i & 2) / 2 * (height - 1));
      const Vector2<T> pixel = (i < 4 ? corner : somewhere).template cast<T>();
      const auto X = random_point(random, camera, pixel);
      if (!X) continue;
      ++tested;
      Vector3<T> origin;
      const Projection<T> image = camera.project(*X, nullptr, &origin);
      EXPECT_TRUE(image.visible) << pixel.transpose();
      // The error of the origin is relative to the point's distance, because this ratio is its
      // effect on the direction.
      const Vector3<T> begin = camera.ray(pixel).origin;
      const double off = static_cast<double>((origin - begin).norm() / (*X - begin).norm());
      const double tolerance = std::is_same_v<T, float> ? 2e-4 : 1e-11;
      EXPECT_LT(off, tolerance) << pixel.transpose();
      largest = std::max(largest, static_cast<double>((image.pixel - pixel).norm()));
    }
  }
  EXPECT_GT(tested, 18000);  // few random points are not in the water
  return largest;
}

TEST(RoundTrip, InDouble) {
  const double largest = largest_round_trip_error<double>(1, 1024, 768);
  report("round trip in double, largest [px]", largest);
  EXPECT_LT(largest, 1e-9);
}

TEST(RoundTrip, InFloatWithFixedSteps) {
  const double largest = largest_round_trip_error<float>(2, 1024, 768);
  report("round trip in float, 1024 px wide, largest [px]", largest);
  EXPECT_LT(largest, 2e-3);
}

TEST(RoundTrip, InFloatOfLargerImages) {
  for (const int width : {2048, 6000}) {
    const double largest = largest_round_trip_error<float>(3, width, width * 3 / 4);
    report("round trip in float, larger images, largest / width", largest / width);
    EXPECT_LT(largest, 2e-6 * width);
  }
}

// Tests ports with a tilt so strong that some pixels have an incidence of 87 degrees. The solver
// then takes more steps; the accuracy must be the same.
TEST(RoundTrip, InFloatThroughStronglyTiltedPorts) {
  Random random(7);
  int tested = 0;
  for (int k = 0; k < 1000; ++k) {
    View view = random_view(random);
    view.port.normal = tilted_normal(random.uniform(20, 75) * kDegree, random.uniform(0, 6));
    const auto camera = view.camera<float>();
    const Vector2<float> pixel = random_pixel(random, view).cast<float>();
    if (camera.lens().bearing(pixel).normalized().dot(camera.port().normal) < 0.05f) continue;
    const AxialRay<float> ray = camera.ray(pixel);
    const float exit = (camera.exit_point(pixel) - ray.origin).norm();
    const auto image = camera.project(ray.at(exit + static_cast<float>(random.uniform(0.3, 3))));
    ++tested;
    EXPECT_TRUE(image.visible);
    EXPECT_LT((image.pixel - pixel).norm(), 2e-3f);
  }
  EXPECT_GT(tested, 700);
}

// Compares float with double for the same point and the same port. A round trip in float alone
// would not detect an error that both directions share.
TEST(RoundTrip, FloatAgreesWithDouble) {
  Random random(5);
  double largest = 0;
  for (int k = 0; k < 5000; ++k) {
    const View view = random_view(random);
    const auto camera = view.camera<float>();
    const FlatPortCamera<double> same(camera.lens().cast<double>(), camera.port().cast<double>(),
                                      view.width, view.height);
    const auto X = random_point(random, camera, random_pixel(random, view).cast<float>().eval());
    if (!X) continue;
    const Vector2<double> expected = same.project(X->cast<double>()).pixel;
    largest = std::max(largest, (camera.project(*X).pixel.cast<double>() - expected).norm());
  }
  EXPECT_LT(largest, 2e-3);
}

// The ray passes through exit_point(), which lies on the outer plane.
TEST(RoundTrip, ExitPointLiesOnTheRayAndTheOuterPlane) {
  Random random(6);
  for (int k = 0; k < 2000; ++k) {
    const View view = random_view(random);
    const auto camera = view.camera<double>();
    const Vector2<double> pixel = random_pixel(random, view);
    const Vector3<double> exit = camera.exit_point(pixel);
    const AxialRay<double> ray = camera.ray(pixel);
    EXPECT_NEAR(exit.dot(view.port.normal), camera.optics().outer(), 1e-14);
    EXPECT_LT((exit - ray.origin).cross(ray.direction).norm(), 1e-14);
  }
}

}  // namespace
}  // namespace axial::refractive::testing
