// SPDX-License-Identifier: GPL-3.0-or-later
// Tests four limits in which a flat port equals a simpler camera, with a relative tolerance of
// 1e-12.
#include <gtest/gtest.h>

#include "refractive/pinhole_camera.h"
#include "refractive/views.h"

namespace axial::refractive::testing {
namespace {

constexpr double kRelative = 1e-12;

// Expects equal rays, and equal images of points on these rays. The tolerance kRelative is relative
// to 1 for directions, to 1 m for origins and to the image's width for pixels.
template <class A, class B>
void expect_same_camera(const View& view, const A& a, const B& b, Random& random) {
  for (int k = 0; k < 20; ++k) {
    const Vector2<double> pixel = random_pixel(random, view);
    const AxialRay<double> ray = a.ray(pixel);
    const AxialRay<double> other = b.ray(pixel);
    EXPECT_LT((ray.origin - other.origin).norm(), kRelative);
    EXPECT_LT((ray.direction - other.direction).norm(), kRelative);
    const Vector3<double> X = ray.at(random.log_uniform(0.6, 10));
    const auto image = a.project(X);
    const auto other_image = b.project(X);
    EXPECT_EQ(image.visible, other_image.visible);
    if (image.visible) {
      EXPECT_LT((image.pixel - other_image.pixel).norm(), kRelative * view.width);
    }
  }
}

template <class Change>
void for_random_views(unsigned seed, Change change) {
  Random random(seed);
  for (int k = 0; k < 500; ++k) {
    View view = random_view(random);
    view.port.distance = random.log_uniform(0.001, 0.03);  // points at 0.6 m are all in the water
    change(view, random);
  }
}

TEST(Limits, EqualIndicesAreAPinholeForAnyDistances) {
  for_random_views(21, [](View view, Random& random) {
    view.port.n_glass = view.port.n_water = view.port.n_air;
    expect_same_camera(view, view.camera<double>(), PinholeCamera<double>(view.lens), random);
  });
}

TEST(Limits, NoDistancesAreACentralCamera) {
  for_random_views(22, [](View view, Random& random) {
    view.port.distance = view.port.thickness = 0;
    const auto camera = view.camera<double>();
    const double mu = view.port.n_water / view.port.n_air;
    const Matrix3<double> B = camera.rotation_to_axis();
    for (int k = 0; k < 20; ++k) {
      const Vector2<double> pixel = random_pixel(random, view);
      const AxialRay<double> ray = camera.ray(pixel);
      EXPECT_LT(ray.origin.norm(), kRelative);
      const Vector3<double> a = B * view.lens.bearing(pixel);
      const double x = a.x() / a.z();
      const double y = a.y() / a.z();
      const double q_w = std::sqrt(mu * mu + (mu * mu - 1) * (x * x + y * y));
      const Vector3<double> expected = Vector3<double>(x / q_w, y / q_w, 1).normalized();
      EXPECT_LT((B * ray.direction - expected).norm(), kRelative);
      // The whole half space in air is mapped to the points with rho/z < 1/sqrt(mu_w^2 - 1).
      const Projection<double> image = camera.project(ray.at(1));
      EXPECT_TRUE(image.visible);
      EXPECT_LT((image.pixel - pixel).norm(), kRelative * view.width);
      const double ratio = random.uniform(1, 20) / std::sqrt(mu * mu - 1);
      EXPECT_FALSE(camera.project(B.transpose() * Vector3<double>(ratio, 0, 1)).visible);
    }
  });
}

TEST(Limits, GlassLikeAirIsAWiderGap) {
  for_random_views(23, [](View view, Random& random) {
    view.port.n_glass = view.port.n_air;
    View bare = view;
    bare.port.distance += bare.port.thickness;
    bare.port.thickness = 0;
    bare.port.n_glass = 1.5;  // without effect, since the thickness is 0
    expect_same_camera(view, view.camera<double>(), bare.camera<double>(), random);
  });
}

TEST(Limits, GlassLikeWaterOrNoGlassIsTheThinPort) {
  for_random_views(24, [](View view, Random& random) {
    View thin = view;
    thin.port.thickness = 0;
    view.port.n_glass = view.port.n_water;
    const auto camera = view.camera<double>();
    expect_same_camera(view, camera, thin.camera<double>(), random);
    const Vector2<double> pixel = random_pixel(random, view);
    const Vector3<double> m = view.lens.bearing(pixel);
    const double along = m.dot(view.port.normal);
    const double s = m.squaredNorm() / (along * along) - 1;
    const double mu = view.port.n_water / view.port.n_air;
    const double z_v = view.port.distance * (1 - std::sqrt(mu * mu + (mu * mu - 1) * s));
    EXPECT_LT((camera.ray(pixel).origin - z_v * view.port.normal).norm(), kRelative);
  });
}

}  // namespace
}  // namespace axial::refractive::testing
