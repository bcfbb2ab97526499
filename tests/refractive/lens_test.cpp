// SPDX-License-Identifier: GPL-3.0-or-later
// Tests lenses with distortion, without a port and behind ports.
#include <gtest/gtest.h>

#include "refractive/differences.h"
#include "refractive/lens_views.h"

namespace axial::refractive::testing {
namespace {

// A point on the pixel's ray, 1 to 5 m from the lens or from the port.
template <class Camera, class T = typename Camera::Scalar>
Vector3<T> point_seen(Random& random, const Camera& camera, const Vector2<T>& pixel) {
  const AxialRay<T> ray = camera.ray(pixel);
  const T exit = (camera.exit_point(pixel) - ray.origin).dot(ray.direction);
  return ray.at(exit + static_cast<T>(random.uniform(1, 5)));
}

template <class View>
View random_view_of(Random& random) {
  if constexpr (std::is_same_v<View, LensFlatView>)
    return random_flat_lens(random);
  else if constexpr (std::is_same_v<View, LensDomeView>)
    return random_dome_lens(random);
  else
    return random_lens(random);
}

template <class View>
class Lenses : public ::testing::Test {};
using Views = ::testing::Types<LensView, LensFlatView, LensDomeView>;
TYPED_TEST_SUITE(Lenses, Views);

template <class View, class T>
double largest_round_trip_error() {
  Random random(101);
  double largest = 0;
  for (int k = 0; k < 300; ++k) {
    const View view = random_view_of<View>(random);
    const auto camera = view.template camera<T>();
    for (int i = 0; i < 20; ++i) {
      const Vector2<double> corner((i & 1) * (view.width - 1), (i & 2) / 2 * (view.height - 1));
      const Vector2<T> pixel = (i < 4 ? corner : random_pixel(random, view)).template cast<T>();
      const auto image = camera.project(point_seen(random, camera, pixel));
      EXPECT_TRUE(image.visible) << pixel.transpose();
      largest = std::max(largest, static_cast<double>((image.pixel - pixel).norm()));
    }
  }
  return largest;
}

TYPED_TEST(Lenses, ProjectWhatTheyBackProject) {
  const double in_double = largest_round_trip_error<TypeParam, double>();
  report("round trip with distortion in double, largest [px]", in_double);
  EXPECT_LT(in_double, 1e-9);
  const double in_float = largest_round_trip_error<TypeParam, float>();
  report("round trip with distortion in float, largest [px]", in_float);
  // A fisheye of 75 degrees and a tilt of the port give nearly grazing rays. For such rays a flat
  // port magnifies angles in water five times.
  EXPECT_LT(in_float, 5e-3);
}

// A round trip in float alone would not detect an error that both directions share.
TYPED_TEST(Lenses, InFloatAgreeWithDouble) {
  Random random(102);
  for (int k = 0; k < 300; ++k) {
    const TypeParam view = random_view_of<TypeParam>(random);
    const auto exact = view.template camera<double>();
    const auto rounded = view.template camera<float>();
    for (int i = 0; i < 20; ++i) {
      const Vector3<double> X = point_seen(random, exact, random_pixel(random, view));
      const auto image = rounded.project(X.template cast<float>());
      EXPECT_LT((image.pixel.template cast<double>() - exact.project(X).pixel).norm(), 5e-3);
    }
  }
}

TYPED_TEST(Lenses, KnowTheDerivativeOfTheProjection) {
  Random random(103);
  for (int k = 0; k < 500; ++k) {
    const TypeParam view = random_view_of<TypeParam>(random);
    const auto camera = view.template camera<double>();
    check_projection(view, point_seen(random, camera, random_pixel(random, view)));
  }
}

TYPED_TEST(Lenses, KnowTheDerivativeOfTheRay) {
  using Jet = ceres::Jet<double, 2>;
  Random random(104);
  for (int k = 0; k < 500; ++k) {
    const TypeParam view = random_view_of<TypeParam>(random);
    const auto camera = view.template camera<double>();
    const Vector2<double> pixel =
        k % 10 ? random_pixel(random, view) : Vector2<double>(view.lens.cx, view.lens.cy);
    AxialRayJacobian<double> jacobian;
    const AxialRay<double> ray = camera.ray(pixel, jacobian);
    const AxialRay<double> plain = camera.ray(pixel);
    EXPECT_LT((ray.origin - plain.origin).norm() + (ray.direction - plain.direction).norm(), 1e-15);
    // For a point of the ray at 1 m, an error of the origin counts as much as one of the direction.
    const double scale = jacobian.direction.norm();
    const auto jets = view.template camera<Jet>().ray(variables<Jet, 2>(pixel));
    expect_close(jacobian.direction, derivatives<Jet, 3>(jets.direction), scale);
    expect_close(jacobian.origin, derivatives<Jet, 3>(jets.origin), scale);
    const auto at = [&](const Vector2<double>& p) { return camera.ray(p).at(1); };
    expect_close(Matrix32<double>(jacobian.origin + jacobian.direction),
                 differences<3, 2>(pixel, 1e-3, at), scale);
  }
}

// Newton's method must not lose the derivatives by the parameters of the lens.
TEST(LensDistortion, CarriesTheDerivativesByItsParameters) {
  using Jet = ceres::Jet<double, 4>;
  Random random(105);
  for (int k = 0; k < 300; ++k) {
    const LensView view = random_lens(random);
    const Vector2<double> pixel = random_pixel(random, view);
    const auto ray = [&]<class T>(const Eigen::Matrix<T, 4, 1>& p) {
      auto lens = view.distorted<T>();
      lens.pinhole.fx = p(0);
      lens.distortion.above[1] = p(1);
      lens.distortion.below[0] = p(2);
      lens.distortion.p1 = p(3);
      return LensPinholeCamera<T>(lens).ray(pixel.cast<T>()).direction;
    };
    const Eigen::Vector4d p(view.lens.fx, view.distortion.above[1], view.distortion.below[0],
                            view.distortion.p1);
    const auto jacobian = derivatives<Jet, 3>(ray(variables<Jet, 4>(p)));
    const auto numeric =
        differences<3, 4>(p, 1e-6, [&](const Eigen::Vector4d& q) { return ray(q); });
    for (int i = 0; i < 4; ++i)
      EXPECT_LT((jacobian.col(i) - numeric.col(i)).norm(), 1e-8 + 1e-6 * jacobian.col(i).norm());
  }
}

template <class T, class Lens, class Straight>
void expect_the_same(Random& random, const Lens& lens, const Straight& straight, T pixels) {
  for (int i = 0; i < 20; ++i) {
    const Vector2<T> pixel(static_cast<T>(random.uniform(0, 1023)),
                           static_cast<T>(random.uniform(0, 767)));
    AxialRayJacobian<T> a, b;
    const AxialRay<T> ray = lens.ray(pixel, a), expected = straight.ray(pixel, b);
    const T angle = pixels / 500;
    EXPECT_LT((ray.direction - expected.direction).norm(), angle);
    EXPECT_LT((ray.origin - expected.origin).norm(), angle);
    EXPECT_LT((a.direction - b.direction).norm(), angle * T(1e-2));
    const Vector3<T> X = point_seen(random, straight, pixel);
    Matrix23<T> along, across;
    const auto image = lens.project(X, &along), same = straight.project(X, &across);
    EXPECT_TRUE(image.visible);
    EXPECT_LT((image.pixel - same.pixel).norm(), pixels);
    EXPECT_LT((along - across).norm(), pixels * 10);
  }
}

template <class T>
void expect_straight_cameras(T pixels) {
  Random random(106);
  for (int k = 0; k < 100; ++k) {
    View flat = random_view(random);
    flat.port.normal = tilted_normal(random.uniform(0, 10) * kDegree, 1);
    const DomeView dome = random_dome_view(random);
    const DistortedLens<T> lens(flat.lens, {}, flat.width, flat.height);
    expect_the_same<T>(random, LensPinholeCamera<T>(lens), PinholeCamera<T>(flat.lens.cast<T>()),
                       pixels);
    expect_the_same<T>(random, LensFlatPortCamera<T>(lens, flat.port.cast<T>()), flat.camera<T>(),
                       pixels);
    expect_the_same<T>(
        random,
        LensDomePortCamera<T>(DistortedLens<T>(dome.lens, {}, dome.width, dome.height),
                              dome.port.cast<T>()),
        dome.camera<T>(), pixels);
  }
}

TEST(LensCamera, WithoutDistortionIsTheStraightOne) {
  expect_straight_cameras<double>(1e-9);
  expect_straight_cameras<float>(5e-3f);
}

TEST(LensCamera, OfAnEquidistantFisheyeCountsAngles) {
  LensView view;
  view.lens = {420, 410, 511, 383};
  view.distortion.fisheye = 1;
  const auto camera = view.camera<double>();
  for (const double degrees : {0.0, 1e-7, 0.3, 20.0, 70.0}) {
    const double angle = degrees * kDegree;
    const auto ray = camera.ray({511 + 420 * angle * 0.6, 383 + 410 * angle * 0.8});
    const Vector3<double> expected(0.6 * std::sin(angle), 0.8 * std::sin(angle), std::cos(angle));
    EXPECT_LT((ray.direction - expected).norm(), 1e-14) << degrees;
  }
}

TEST(Equidistant, RatiosHoldInBothPrecisions) {
  for (double angle = 0; angle < 87 * kDegree; angle += 0.001) {
    const double tangent = std::tan(angle), ratio = angle > 0 ? tangent / angle : 1;
    EXPECT_NEAR(arc_over_tangent(tangent * tangent), 1 / ratio, 1e-15);
    EXPECT_NEAR(tangent_over_arc(angle * angle), ratio, 1e-14 * ratio * ratio);
    const auto f = static_cast<float>(angle), t = static_cast<float>(tangent);
    EXPECT_NEAR(arc_over_tangent(t * t), 1 / ratio, 3e-7);
    // The effect of the angle's rounding grows with the derivative of the tangent.
    EXPECT_NEAR(tangent_over_arc(f * f), ratio, 3e-7 * (1 + tangent * tangent));
  }
}

// A barrel distortion whose polynomial turns back at the tangent 1/sqrt(0.9). Beyond, it maps
// directions into the image a second time.
TEST(LensField, EndsWhereTheLensFoldsBack) {
  LensView view;
  view.lens = {400, 400, 511.5, 383.5};
  view.distortion.above[1] = -0.3;
  const auto camera = view.camera<double>();
  const auto rounded = view.camera<float>();
  const double fold = std::sqrt(1 / 0.9);
  EXPECT_LT(camera.distorted_lens().field, fold);
  EXPECT_GT(camera.distorted_lens().field, 0.96 * fold);
  for (double r = 0; r < 200; r += 0.01) {
    const Vector3<double> X(r * 0.6, r * 0.8, 1);
    Matrix23<float> jacobian;
    const auto image = rounded.project(X.cast<float>(), &jacobian);
    EXPECT_TRUE(image.pixel.allFinite() && jacobian.allFinite());
    EXPECT_EQ(camera.project(X).visible, image.visible) << r;
    if (r < 0.96 * fold || r > fold) {
      EXPECT_EQ(image.visible, r < fold) << r;
    }
  }
  // A pixel beyond the field has no direction. Its ray is finite, and projects to another pixel.
  const auto ray = rounded.ray({0, 0});
  EXPECT_TRUE(ray.direction.allFinite());
  EXPECT_GT(rounded.project(ray.at(2)).pixel.norm(), 100);
}

// The margin is an eighth of the width of 1024 px.
TEST(LensField, ReachesTheWidenedImage) {
  LensView view;
  view.lens = {600, 600, 511.5, 383.5};
  for (const double fisheye : {0.0, 1.0}) {
    view.distortion.fisheye = fisheye;
    const auto lens = view.distorted<double>();
    for (const double u : {-127.9, -128.1}) {
      for (const double v : {0.0, 383.0}) {
        const Vector2<double> d((u - 511.5) / 600, (v - 383.5) / 600);
        const double ratio = fisheye > 0 ? std::tan(d.norm()) / d.norm() : 1;
        EXPECT_EQ(lens.project(ratio * d).projection.visible, u > -128) << fisheye << " " << u;
      }
    }
  }
}

TEST(LensField, IsNothingForALensTurnedOver) {
  LensView view;
  view.lens = {600, 600, 511.5, 383.5};
  view.distortion.above = {-1, 0, 0, 0, 0};
  EXPECT_EQ(view.distorted<double>().field, 0);
  view.distortion.above[0] = std::nan("");
  EXPECT_EQ(view.distorted<double>().field, 0);
}

}  // namespace
}  // namespace axial::refractive::testing
