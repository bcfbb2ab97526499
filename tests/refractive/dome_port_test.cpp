// SPDX-License-Identifier: GPL-3.0-or-later
// Tests dome ports: against a ray tracer that refracts at one surface after the other, in the round
// trip from pixel to point to pixel, against automatic and numeric derivatives, and in limits where
// a dome equals a simpler camera.
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include "refractive/differences.h"
#include "refractive/dome_views.h"

namespace axial::refractive::testing {
namespace {

using Eigen::Vector3d;

// The point at which a ray from inside a sphere around `centre` leaves the sphere.
Vector3d leave(const Vector3d& from, const Vector3d& along, const Vector3d& centre, double radius) {
  const Vector3d offset = from - centre;
  const double back = offset.dot(along);
  return from + (std::sqrt(back * back + radius * radius - offset.squaredNorm()) - back) * along;
}

// Snell's law with vectors: the component across the normal is scaled by `ratio`; the component
// along the normal follows from the unit length.
Vector3d refract(const Vector3d& along, const Vector3d& normal, double ratio) {
  const Vector3d across = ratio * (along - along.dot(normal) * normal);
  return across + std::sqrt(1 - across.squaredNorm()) * normal;
}

struct Traced {
  Vector3d exit, direction;
};

Traced trace(const DomeView& view, const Vector2<double>& pixel) {
  const DomePort<double>& port = view.port;
  const Vector3d air = view.lens.bearing(pixel).normalized();
  const Vector3d inner = leave(Vector3d::Zero(), air, port.centre, port.inner_radius);
  const Vector3d glass =
      refract(air, (inner - port.centre).normalized(), port.n_air / port.n_glass);
  const Vector3d outer = leave(inner, glass, port.centre, view.outer_radius());
  return {outer, refract(glass, (outer - port.centre).normalized(), port.n_glass / port.n_water)};
}

TEST(DomePort, AgreesWithATracedRay) {
  Random random(1);
  double largest = 0;
  for (int k = 0; k < 5000; ++k) {
    const DomeView view = random_dome_view(random, 0.8);
    const Vector2<double> pixel = random_pixel(random, view);
    const auto camera = view.camera<double>();
    const Traced traced = trace(view, pixel);
    const AxialRay<double> ray = camera.ray(pixel);
    // Compares the direction of the line, and its position [m] at the glass.
    const double off = std::max((ray.direction - traced.direction).norm(),
                                (traced.exit - ray.origin).cross(ray.direction).norm());
    largest = std::max({largest, off, (camera.exit_point(pixel) - traced.exit).norm()});
    ASSERT_LT(ray.origin.cross(view.port.centre).norm(), 1e-15);  // on the axis
  }
  report("dome against a traced ray, largest", largest);
  EXPECT_LT(largest, 1e-12);
}

template <class T>
double largest_round_trip_error(unsigned seed, double decentring) {
  Random random(seed);
  double largest = 0;
  for (int k = 0; k < 2000; ++k) {
    const DomeView view = random_dome_view(random, decentring);
    const auto camera = view.camera<T>();
    for (int i = 0; i < 10; ++i) {
      // Some pixels are corners, where the incidence is largest.
      const Vector2<double> corner((i & 1) * (view.width - 1), (i & 2) / 2 * (view.height - 1));
      const Vector2<T> pixel = (i < 4 ? corner : random_pixel(random, view)).template cast<T>();
      const Vector3<T> X = random_point(random, camera, pixel);
      Vector3<T> origin;
      const Projection<T> image = camera.project(X, nullptr, &origin);
      EXPECT_TRUE(image.visible) << pixel.transpose();
      const T off = (origin - camera.ray(pixel).origin).norm() / X.norm();
      EXPECT_LT(off, (std::is_same_v<T, float> ? T(2e-4) : T(1e-11)));
      largest = std::max(largest, static_cast<double>((image.pixel - pixel).norm()));
    }
  }
  return largest;
}

TEST(DomePort, TakesAPixelThereAndBackInDouble) {
  const double largest = largest_round_trip_error<double>(2, 0.8);
  report("dome round trip in double, largest [px]", largest);
  EXPECT_LT(largest, 1e-9);
}

TEST(DomePort, TakesAPixelThereAndBackInFloatWithFixedSteps) {
  for (const double decentring : {0.1, 0.4, 0.8}) {
    const double largest = largest_round_trip_error<float>(3, decentring);
    report("dome round trip in float, 1024 px wide, largest [px]", largest);
    EXPECT_LT(largest, 2e-3);
  }
}

void check_ray(const DomeView& view, const Vector2<double>& pixel) {
  using Jet = ceres::Jet<double, 2>;
  const auto camera = view.camera<double>();
  AxialRayJacobian<double> jacobian;
  camera.ray(pixel, jacobian);
  const auto jets = view.camera<Jet>().ray(variables<Jet, 2>(pixel));
  const double scale = jacobian.direction.norm();
  expect_close(jacobian.direction, derivatives<Jet, 3>(jets.direction), scale);
  expect_close(jacobian.origin, derivatives<Jet, 3>(jets.origin), scale);
  const double h = 1e-3;
  expect_close(jacobian.direction,
               differences<3, 2>(pixel, h,
                                 [&](const Vector2<double>& p) { return camera.ray(p).direction; }),
               scale);
  expect_close(
      jacobian.origin,
      differences<3, 2>(pixel, h, [&](const Vector2<double>& p) { return camera.ray(p).origin; }),
      scale);
}

TEST(DomePort, HasTheDerivativesOfJetsAndDifferences) {
  Random random(4);
  for (int k = 0; k < 1000; ++k) {
    const DomeView view = random_dome_view(random, 0.8);
    const Vector2<double> pixel = random_pixel(random, view);
    check_projection(view, random_point(random, view.camera<double>(), pixel));
    check_ray(view, pixel);
  }
}

// Tests pixels on and near the axis, for axes of any direction, and domes that are exactly or
// almost centred.
TEST(DomePort, IsSmoothOnTheAxisAndAtTheCentre) {
  Random random(5);
  for (int k = 0; k < 100; ++k) {
    DomeView view = random_dome_view(random);
    const Vector2<double> pixel = random_pixel(random, view);
    const Vector3d axis = view.lens.bearing(pixel).normalized();
    for (const double decentring : {0.0, 1e-15, 1e-9, 1e-5, 0.01, -0.01}) {
      view.port.centre = decentring * axis;
      for (const double away : {0.0, 1e-12, 1e-6, 1.0}) {
        const Vector2<double> near = pixel + Vector2<double>(away, 0.3 * away);
        check_projection(view, random_point(random, view.camera<double>(), near));
        check_ray(view, near);
      }
    }
  }
}

// Bundle adjustment needs derivatives by the parameters of the port, also for a centred dome.
TEST(DomePort, HasDerivativesByItsParameters) {
  using Jet = ceres::Jet<double, 7>;
  using Parameters = Eigen::Matrix<double, 7, 1>;
  Random random(6);
  for (int k = 0; k < 300; ++k) {
    DomeView view = random_dome_view(random);
    if (k % 10 == 0) view.port.centre.setZero();
    const Vector3d X = random_point(random, view.camera<double>(), random_pixel(random, view));
    const auto project = [&]<class T>(const Eigen::Matrix<T, 7, 1>& p) {
      DomePort<T> port = view.port.cast<T>();
      port.centre = p.template head<3>();
      port.inner_radius = p(3);
      port.thickness = p(4);
      port.n_glass = p(5);
      port.n_water = p(6);
      const DomePortCamera<T> camera(view.lens.cast<T>(), port, view.width, view.height);
      return camera.project(X.cast<T>()).pixel;
    };
    Parameters p;
    p << view.port.centre, view.port.inner_radius, view.port.thickness, view.port.n_glass,
        view.port.n_water;
    const Eigen::Matrix<double, 2, 7> jacobian = derivatives<Jet, 2>(project(variables<Jet, 7>(p)));
    const auto numeric =
        differences<2, 7>(p, 1e-6, [&](const Parameters& q) { return project(q); });
    expect_close(jacobian, numeric, jacobian.norm());
  }
}

TEST(DomePort, BendsNothingWhereItIsCentred) {
  Random random(7);
  for (int k = 0; k < 1000; ++k) {
    DomeView view = random_dome_view(random);
    view.port.centre.setZero();
    const PinholeCamera<double> dry(view.lens);
    const Vector2<double> pixel = random_pixel(random, view);
    const AxialRay<double> ray = view.camera<double>().ray(pixel);
    EXPECT_LT((ray.direction - dry.ray(pixel).direction).norm(), 1e-15);
    EXPECT_EQ(ray.origin.norm(), 0);
    const Vector3d X = ray.at(random.uniform(0.5, 5));
    EXPECT_LT((view.camera<double>().project(X).pixel - pixel).norm(), 1e-10);
  }
}

// With equal indices the spheres have no effect. The tolerance 1e-12 is that of the limits of flat
// ports.
TEST(DomePort, IsThePinholeCameraWhereAllIndicesAreEqual) {
  Random random(10);
  for (int k = 0; k < 1000; ++k) {
    DomeView view = random_dome_view(random, 0.8);
    view.port.n_glass = view.port.n_water = view.port.n_air;
    const auto camera = view.camera<double>();
    const PinholeCamera<double> dry(view.lens);
    const Vector2<double> pixel = random_pixel(random, view);
    const AxialRay<double> ray = camera.ray(pixel);
    EXPECT_LT((ray.direction - dry.ray(pixel).direction).norm(), 1e-12);
    EXPECT_LT(ray.origin.norm(), 1e-12);
    const Vector3d X = random_point(random, camera, pixel);
    Matrix23<double> jacobian, expected;
    const Projection<double> image = camera.project(X, &jacobian);
    EXPECT_TRUE(image.visible);
    EXPECT_LT((image.pixel - dry.project(X, &expected).pixel).norm(), 1e-12 * view.width);
    EXPECT_LT((jacobian - expected).norm(), 1e-11 * expected.norm());
  }
}

// A sphere with a radius of a kilometre is almost a plane. The remaining difference is the
// curvature of the glass within the port.
TEST(DomePort, BecomesAFlatPortWhenItGrows) {
  Random random(8);
  for (int k = 0; k < 200; ++k) {
    const View flat = random_view(random);
    DomeView dome{flat.width, flat.height, flat.lens, {}};
    constexpr double kRadius = 1e3;
    dome.port = {(flat.port.distance - kRadius) * flat.port.normal,
                 kRadius,
                 flat.port.thickness,
                 flat.port.n_air,
                 flat.port.n_glass,
                 flat.port.n_water};
    const Vector2<double> pixel = random_pixel(random, dome);
    const AxialRay<double> ray = flat.camera<double>().ray(pixel);
    const AxialRay<double> found = dome.camera<double>().ray(pixel);
    // The normals of the glass differ by up to 1e-3 rad within the port.
    EXPECT_LT((found.direction - ray.direction).norm(), 1e-3);
    EXPECT_LT(
        (dome.camera<double>().exit_point(pixel) - flat.camera<double>().exit_point(pixel)).norm(),
        1e-3);
  }
}

template <class T>
class DomeVisibility : public ::testing::Test {};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(DomeVisibility, Scalars);

// Tests points inside the dome, behind the lens, outside the image, and NaN.
TYPED_TEST(DomeVisibility, IsNeverClaimedWrongly) {
  using T = TypeParam;
  Random random(9);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  int visible = 0;
  for (int k = 0; k < 20000; ++k) {
    const DomeView view = random_dome_view(random);
    const auto camera = view.camera<T>();
    Vector3d X = random.unit_vector() * random.log_uniform(1e-3, 20);
    if (k % 2) X.z() = std::abs(X.z());
    if (k % 50 == 0) X(k % 3) = kNan;
    if (k % 51 == 0) X *= 1e30;
    Matrix23<T> jacobian;
    const Projection<T> image = camera.project(X.cast<T>(), &jacobian);
    EXPECT_TRUE(image.pixel.allFinite() && jacobian.allFinite()) << X.transpose();
    if (!image.visible) continue;
    ++visible;
    EXPECT_GT((X - view.port.centre).norm(), view.outer_radius() * (1 - 1e-6));
    EXPECT_GE(image.pixel.x(), T(-128));
    EXPECT_LE(image.pixel.x(), T(view.width + 127));
    // The ray of the pixel passes through the point.
    const AxialRay<T> ray = camera.ray(image.pixel);
    const Vector3<T> to = X.cast<T>() - ray.origin;
    EXPECT_GT(to.dot(ray.direction), T(0));
    EXPECT_LT(to.cross(ray.direction).norm(), T(2e-5) * to.norm());
  }
  EXPECT_GT(visible, 2000);
}

}  // namespace
}  // namespace axial::refractive::testing
