// SPDX-License-Identifier: GPL-3.0-or-later
// A point that a camera does not see must not be reported as visible, and its pixel must be finite.
#include <gtest/gtest.h>

#include <limits>

#include "refractive/pinhole_camera.h"
#include "refractive/views.h"

namespace axial::refractive::testing {
namespace {

// The pixel of X, by bisection of the increasing function radius(t), without the field test, the
// solver and the image rectangle. Empty if no light from X reaches the lens from the front.
std::optional<Vector2<double>> image_by_bisection(const View& view, const Vector3<double>& X) {
  const FlatPortOptics<double> optics(view.port);
  const Vector3<double>& n = view.port.normal;
  const double z_water = n.dot(X) - optics.outer();
  if (!(z_water > 0)) return std::nullopt;
  const Vector3<double> across = X - n.dot(X) * n;
  const double rho = across.norm();
  double low = 0;
  double high = 1e9;
  if (optics.radius(high, z_water) < rho) return std::nullopt;
  for (int k = 0; k < 200; ++k) {
    const double t = 0.5 * (low + high);
    (optics.radius(t, z_water) < rho ? low : high) = t;
  }
  const Vector3<double> bearing = n + across * (low / rho);
  if (!(bearing.z() > 1e-6)) return std::nullopt;
  return view.lens.pixel(bearing);
}

// Distance of a pixel from the image rectangle along the axes; 0 inside.
double distance_from_image(const View& view, const Vector2<double>& pixel) {
  const double u = std::max({0.0, -pixel.x(), pixel.x() - (view.width - 1)});
  const double v = std::max({0.0, -pixel.y(), pixel.y() - (view.height - 1)});
  return std::max(u, v);
}

template <class T>
class Visibility : public ::testing::Test {};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(Visibility, Scalars);

TYPED_TEST(Visibility, OnlyPointsInTheWidenedImageUpToRhoOverZOf20) {
  using T = TypeParam;
  Random random(11);
  int seen = 0;
  int outside = 0;
  for (int k = 0; k < 20000; ++k) {
    View view = random_view(random);
    if (k % 5 == 0) view.port.distance = 0;
    const auto camera = view.camera<T>();
    const Vector3<double> n = view.port.normal;
    const Vector3<double> e = (random.unit_vector().cross(n)).normalized();
    const double z = random.log_uniform(0.05, 10);
    const Vector3<double> X = z * (n + random.log_uniform(0.01, 20) * e);
    const Projection<T> image = camera.project(X.cast<T>());
    const auto expected = image_by_bisection(view, X);
    const double away = expected ? distance_from_image(view, *expected) : 1e9;
    EXPECT_TRUE(image.pixel.allFinite());
    if (away == 0) {
      EXPECT_TRUE(image.visible);
      ++seen;
    }
    // The margin is 128 px, an eighth of the width. 0.1 px allows for rounding near its edge.
    if (away > 128.1) {
      EXPECT_FALSE(image.visible) << X.transpose() << " at " << image.pixel.transpose();
      ++outside;
    }
    if (image.visible) {
      EXPECT_LT((image.pixel.template cast<double>() - *expected).norm(), 5e-3) << X.transpose();
    }
  }
  EXPECT_GT(seen, 2000);
  EXPECT_GT(outside, 5000);
}

TYPED_TEST(Visibility, NothingOnTheLensSideOfTheOuterPlane) {
  using T = TypeParam;
  Random random(12);
  for (int k = 0; k < 5000; ++k) {
    const View view = random_view(random);
    const auto camera = view.camera<T>();
    Vector3<double> X = random.unit_vector() * random.log_uniform(1e-6, 20);
    const double height = X.dot(view.port.normal);
    const double outer = view.port.distance + view.port.thickness;
    if (height > outer) X -= (height - random.uniform(0, outer)) * view.port.normal;
    Matrix23<T> jacobian;
    const Projection<T> image = camera.project(X.cast<T>(), &jacobian);
    EXPECT_FALSE(image.visible);
    EXPECT_TRUE(image.pixel.allFinite() && jacobian.allFinite());
  }
}

// Without distance and thickness, terms of the projection grow as powers of the inverse height.
TYPED_TEST(Visibility, NothingBehindATiltedPortAtTheLens) {
  using T = TypeParam;
  Random random(15);
  for (int k = 0; k < 2000; ++k) {
    View view = random_view(random);
    view.port.distance = view.port.thickness = 0;
    view.port.normal = tilted_normal(random.uniform(0, 60) * kDegree, random.uniform(0, 6));
    Vector3<double> X = random.unit_vector() * random.log_uniform(1e-2, 20);
    const double height = X.dot(view.port.normal);
    X -= (height + std::abs(height) + 1e-3) * view.port.normal;
    Matrix23<T> jacobian;
    const Projection<T> image = view.camera<T>().project(X.cast<T>(), &jacobian);
    EXPECT_FALSE(image.visible);
    EXPECT_TRUE(image.pixel.allFinite() && jacobian.allFinite()) << X.transpose();
  }
}

TYPED_TEST(Visibility, NothingBeyondTotalReflection) {
  using T = TypeParam;
  Random random(13);
  for (int k = 0; k < 5000; ++k) {
    View view = random_view(random);
    view.port.distance = 0;  // with an air gap, light from every point in the water enters the air
    const double c_g = std::pow(view.port.n_glass / view.port.n_air, 2) - 1;
    const double c_w = std::pow(view.port.n_water / view.port.n_air, 2) - 1;
    const double z = random.log_uniform(0.05, 10);
    const double bound = view.port.thickness / std::sqrt(c_g) + z / std::sqrt(c_w);
    const Vector3<double> e = random.unit_vector().cross(view.port.normal).normalized();
    const Vector3<double> X =
        (z + view.port.thickness) * view.port.normal + bound * random.log_uniform(1, 20) * e;
    EXPECT_FALSE(view.camera<T>().project(X.cast<T>()).visible);
  }
}

TYPED_TEST(Visibility, BadNumbersAreNotVisibleAndTheAnswerIsFinite) {
  using T = TypeParam;
  const T nan = std::numeric_limits<T>::quiet_NaN();
  const T infinity = std::numeric_limits<T>::infinity();
  const T huge = std::numeric_limits<T>::max();
  Random random(14);
  for (int k = 0; k < 50; ++k) {
    const View view = random_view(random);
    const auto port = view.camera<T>();
    const PinholeCamera<T> pinhole(view.lens.cast<T>());
    for (const T& bad : {nan, infinity, -infinity, huge, -huge}) {
      for (int i = 1; i < 8; ++i) {
        Vector3<T> X(T(0.1), T(0.2), T(1));
        for (int j = 0; j < 3; ++j)
          if (i & (1 << j)) X(j) = bad;
        for (const auto& image : {port.project(X), pinhole.project(X)})
          EXPECT_TRUE(image.pixel.allFinite()) << X.transpose();
        Matrix23<T> a, b;
        const bool seen = port.project(X, &a).visible;
        EXPECT_FALSE(seen) << X.transpose();
        pinhole.project(X, &b);
        EXPECT_TRUE(a.allFinite() && b.allFinite()) << X.transpose();
        if (!X.allFinite() && !(i == 4 && bad == infinity)) {
          EXPECT_FALSE(pinhole.project(X).visible) << X.transpose();
        }
      }
    }
  }
}

TYPED_TEST(Visibility, TheAxisItselfIsSeen) {
  using T = TypeParam;
  Random random(15);
  for (int k = 0; k < 1000; ++k) {
    const View view = random_view(random);
    const auto camera = view.camera<T>();
    const Vector3<T> X = camera.port().normal * T(1.5);
    Matrix23<T> jacobian;
    const Projection<T> image = camera.project(X, &jacobian);
    const Vector2<T> expected = camera.lens().pixel(camera.port().normal);
    EXPECT_LT((image.pixel - expected).norm(), (std::is_same_v<T, float> ? T(1e-3) : T(1e-10)));
    EXPECT_TRUE(jacobian.allFinite());
  }
}

// Pixels that look parallel to the port or away from it must have finite rays.
TYPED_TEST(Visibility, GrazingPixelsHaveFiniteRays) {
  using T = TypeParam;
  const View view{1000,
                  800,
                  lens_with_fov(110, 1000, 800),
                  {tilted_normal(60 * kDegree, 0), 0.02, 0.01, 1, 1.5, 1.33}};
  const auto camera = view.camera<T>();
  for (int u = 0; u < 1000; u += 7) {
    AxialRayJacobian<T> jacobian;
    const AxialRay<T> ray = camera.ray({T(u), T(0)}, jacobian);
    EXPECT_TRUE(ray.origin.allFinite() && ray.direction.allFinite()) << u;
    EXPECT_TRUE(jacobian.origin.allFinite() && jacobian.direction.allFinite()) << u;
    EXPECT_NEAR(ray.direction.norm(), 1, 1e-6);
    EXPECT_GT(ray.direction.dot(camera.port().normal), 0);
  }
}

}  // namespace
}  // namespace axial::refractive::testing
