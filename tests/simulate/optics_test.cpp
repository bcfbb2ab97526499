// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/optics.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "base/error.h"
#include "refractive/dome_port_camera.h"
#include "refractive/flat_port_camera.h"
#include "refractive/lens_camera.h"

namespace axial::simulate {
namespace {

using Eigen::Vector3d;

const Port kPaperPort{{0, 0, 1}, 0.020, 0.014, 1.0, 1.52, 1.333};

double between(double a, double b) {
  return a + (b - a) * *rc::gen::inRange(0, 1000001) * 1e-6;
}

Port any_port() {
  const double tilt = between(0, 15);
  Port port{tilted_normal(tilt), between(0.001, 0.1), between(0, 0.03), 1,
            between(1.4, 1.8),   between(1.32, 1.36)};
  return port;
}

Lens any_lens() {
  return make_lens(1024, 768, between(50, 110));
}

TEST(Optics, FollowsARayWorkedOutByHand) {
  // The tangent is 0.75 in air (a 3-4-5 triangle). By Snell's law the sine is 0.6/1.52 in glass and
  // 0.6/1.333 in water.
  Lens lens = make_lens(1024, 768, 80);
  const auto ray = trace_pixel(lens, &kPaperPort, lens.cx + 0.75 * lens.focal, lens.cy);
  ASSERT_TRUE(ray);
  // The distance from the axis where the light leaves the glass is 0.020 * 0.75 + 0.014 *
  // 0.4296248625946536.
  EXPECT_NEAR((ray->start - Vector3d(0.02101474807632515, 0, 0.034)).norm(), 0, 1e-15);
  const Vector3d in_water(0.450112528132033, 0, 0.8929718427915797);
  EXPECT_NEAR((ray->direction - in_water).norm(), 0, 1e-15);
  // 0.034 - radius / tan(angle in water) is behind the camera.
  EXPECT_NEAR((ray->on_axis - Vector3d(0, 0, -0.007690859824306652)).norm(), 0, 1e-15);
}

TEST(Optics, RefractsAtTheCriticalAngleAndNotBeyond) {
  const double critical = 1.0 / 1.333;
  const auto at_sine = [&](double s) {
    return refract({s, 0, std::sqrt(1 - s * s)}, {0, 0, 1}, 1.333, 1.0);
  };
  ASSERT_TRUE(at_sine(critical - 1e-9));
  EXPECT_NEAR(at_sine(critical - 1e-9)->z(), 0, 1e-4);
  EXPECT_FALSE(at_sine(critical + 1e-9));
}

TEST(Optics, LimitOnTheAxisIsTheParaxialCentre) {
  const Lens lens = make_lens(1024, 768, 80);
  const auto ray = trace_pixel(lens, &kPaperPort, lens.cx, lens.cy);
  ASSERT_TRUE(ray);
  const double paraxial = 0.020 * (1 - 1.333) + 0.014 * (1 - 1.333 / 1.52);
  // The limit is computed from a ray 1e-4 off the axis. There the crossing has moved by the square
  // of that.
  EXPECT_NEAR(ray->on_axis.z(), paraxial, 1e-8);
  EXPECT_NEAR(ray->direction.z(), 1, 1e-15);
}

RC_GTEST_PROP(Optics, EveryWaterRayMeetsTheAxis, ()) {
  const Port port = any_port();
  const Lens lens = any_lens();
  const auto ray = trace_pixel(lens, &port, between(0, 1023), between(0, 767));
  RC_ASSERT(bool(ray));
  RC_ASSERT(std::abs(ray->direction.norm() - 1) < 1e-14);
  RC_ASSERT(std::abs(ray->start.dot(port.normal) - port.distance - port.thickness) < 1e-14);
  // The point is on the axis by construction and must also be on the ray's line. Within a
  // thousandth of a radian of the axis the crossing is ill-conditioned, and still nearer to the
  // axis the limit replaces it.
  const double slant = ray->direction.cross(port.normal).norm();
  const double tolerance = slant > 1e-3 ? 1e-14 : 1e-11;
  RC_ASSERT((ray->on_axis - ray->start).cross(ray->direction).norm() < tolerance);
}

RC_GTEST_PROP(Optics, AgreesWithTheClosedForm, ()) {
  const Port port = any_port();
  const Lens lens = any_lens();
  const refractive::FlatPortCamera<double> camera(
      {lens.focal, lens.focal, lens.cx, lens.cy},
      {port.normal, port.distance, port.thickness, port.n_air, port.n_glass, port.n_water},
      lens.width, lens.height);
  const Eigen::Vector2d pixel(between(0, 1023), between(0, 767));
  const auto traced = trace_pixel(lens, &port, pixel.x(), pixel.y());
  RC_ASSERT(bool(traced));
  const auto closed = camera.ray(pixel);
  RC_ASSERT((closed.direction - traced->direction).norm() < 1e-13);
  // See above for the crossing near the axis.
  const double slant = traced->direction.cross(port.normal).norm();
  RC_ASSERT((closed.origin - traced->on_axis).norm() < (slant > 1e-3 ? 1e-11 : 1e-7));
  RC_ASSERT((camera.exit_point(pixel) - traced->start).norm() < 1e-13);
}

RC_GTEST_PROP(Optics, AgreesWithTheClosedFormOfDomes, ()) {
  Port port = any_port();
  const double radius = between(0.03, 0.12);
  const Vector3d towards(between(-1, 1), between(-1, 1), between(-1, 1));
  port.dome = Dome{between(0, 0.5) * radius * towards.normalized(), radius};
  const Lens lens = any_lens();
  check_port(port, lens);
  const refractive::DomePortCamera<double> camera(
      {lens.focal, lens.focal, lens.cx, lens.cy},
      {port.dome->centre, radius, port.thickness, port.n_air, port.n_glass, port.n_water},
      lens.width, lens.height);
  const Eigen::Vector2d pixel(between(0, 1023), between(0, 767));
  const auto traced = trace_pixel(lens, &port, pixel.x(), pixel.y());
  RC_ASSERT(bool(traced));
  const auto closed = camera.ray(pixel);
  RC_ASSERT((closed.direction - traced->direction).norm() < 1e-13);
  RC_ASSERT((camera.exit_point(pixel) - traced->start).norm() < 1e-13);
  // See above for the crossing near the axis.
  const double slant = traced->direction.cross(port.dome->centre.normalized()).norm();
  RC_ASSERT((closed.origin - traced->on_axis).norm() < (slant > 1e-3 ? 1e-11 : 1e-7));
}

// A camera that looks down on water at an angle, in a world with z up.
View any_view_of_water(double level) {
  const double incline = between(0, 35) * 3.14159 / 180;
  const Vector3d axis = Vector3d(between(-1, 1), between(-1, 1), 0.1).normalized();
  View view;
  view.rotation = Eigen::AngleAxisd(incline, axis) * Vector3d(1, -1, -1).asDiagonal();
  view.centre = {between(-3, 3), between(-3, 3), level + between(0.1, 30)};
  return view;
}

// The distortion is implemented twice, with two methods of inversion.
RC_GTEST_PROP(Optics, AgreesWithTheClosedFormOfDistortedLenses, ()) {
  Lens lens = make_lens(1024, 768, between(50, 90));
  refractive::LensDistortion<double> distortion;
  const bool fisheye = *rc::gen::inRange(0, 2) == 1;
  if (fisheye) {
    lens.bend = Bend{true, {between(-0.03, 0.03), between(-0.01, 0.01), 0.001, 0.0005}};
    distortion.fisheye = 1;
    for (std::size_t i = 0; i < 4; ++i) distortion.above[i + 1] = lens.bend->k[i];
  } else {
    lens.bend = Bend{false, {between(-0.05, 0.05), between(0, 0.02), between(-2e-3, 2e-3), 1e-3}};
    for (std::size_t i = 0; i < 2; ++i) distortion.above[i + 1] = lens.bend->k[i];
    distortion.p1 = lens.bend->k[2];
    distortion.p2 = lens.bend->k[3];
  }
  check_lens(lens);
  const Port port = any_port();
  const Eigen::Vector2d pixel(between(0, 1023), between(0, 767));
  const refractive::DistortedLens<double> bent({lens.focal, lens.focal, lens.cx, lens.cy},
                                               distortion, lens.width, lens.height);
  const refractive::FlatPort<double> through{port.normal, port.distance, port.thickness,
                                             port.n_air,  port.n_glass,  port.n_water};
  const auto traced = trace_pixel(lens, &port, pixel.x(), pixel.y());
  RC_ASSERT(traced.has_value());
  const auto ray = refractive::LensFlatPortCamera<double>(bent, through).ray(pixel);
  RC_ASSERT((ray.direction - traced->direction).norm() < 1e-12);
  RC_ASSERT((pixel_of(lens, direction_of(lens, pixel.x(), pixel.y())) - pixel).norm() < 1e-8);
}

TEST(Optics, RefusesLensesThatDoNotFillTheImage) {
  Lens lens = make_lens(640, 480, 80);
  lens.bend = Bend{false, {-0.5, 0, 0, 0}};
  EXPECT_THROW(check_lens(lens), Error);
  lens.bend = Bend{true, {-0.3, 0, 0, 0}};
  EXPECT_THROW(check_lens(lens), Error);
}

TEST(Optics, RefusesLensesThatFoldBackBeforeTheCorners) {
  Lens lens = make_lens(640, 480, 80);
  // a (1 - 0.9 a^2 + 0.35 a^4) rises to a = 0.79, falls to 0.96, and rises again up to the corners.
  // The corners have a direction, and so has every pixel before them.
  lens.bend = Bend{true, {-0.9, 0.35, 0, 0}};
  EXPECT_THROW(check_lens(lens), Error);
  // This polynomial does not fall: 1 - 2.7 a^2 + 2 a^4 has no root.
  lens.bend = Bend{true, {-0.9, 0.4, 0, 0}};
  EXPECT_NO_THROW(check_lens(lens));
}

RC_GTEST_PROP(Optics, TheWaterSurfaceStaysInTheWorld, ()) {
  const double level = between(-2, 2);
  const View view = any_view_of_water(level);
  const Port port = surface_port(level, view, 1, 1.333);
  const Lens lens = make_lens(1024, 768, between(30, 60));
  check_port(port, lens);
  const auto traced = trace_pixel(lens, &port, between(0, 1023), between(0, 767));
  RC_ASSERT(bool(traced));
  const SceneRay ray = to_world(view, *traced);
  RC_ASSERT(std::abs(ray.start.z() - level) < 1e-12);
  // Snell's law at a horizontal plane.
  const Vector3d in_air = (ray.start - view.centre).normalized();
  RC_ASSERT((in_air.head<2>() - 1.333 * ray.direction.head<2>()).norm() < 1e-12);
  RC_ASSERT(ray.direction.z() < 0);
}

TEST(Optics, RefusesViewsThatAreNotAboveTheWater) {
  const Lens lens = make_lens(101, 51, 60);
  View view;
  view.rotation = Vector3d(1, -1, -1).asDiagonal();
  view.centre = {0, 0, 2};
  EXPECT_NO_THROW(check_port(surface_port(-20, view, 1, 1.333), lens));
  EXPECT_THROW(check_port(surface_port(2, view, 1, 1.333), lens), Error);
  EXPECT_THROW(check_port(surface_port(2.5, view, 1, 1.333), lens), Error);
  view.rotation.setIdentity();  // looks up
  EXPECT_THROW(check_port(surface_port(0, view, 1, 1.333), lens), Error);
}

TEST(Optics, ACentredDomeBendsNothing) {
  const Lens lens = make_lens(101, 51, 60);
  Port port = kPaperPort;
  port.dome = Dome{{0, 0, 0}, 0.05};
  const auto ray = trace_pixel(lens, &port, 90, 3);
  const auto dry = trace_pixel(lens, nullptr, 90, 3);
  ASSERT_TRUE(ray);
  EXPECT_LT((ray->direction - dry->direction).norm(), 1e-15);
  EXPECT_EQ(ray->on_axis, Vector3d::Zero());
  EXPECT_NEAR(ray->start.norm(), 0.05 + port.thickness, 1e-15);
}

TEST(Optics, WithoutPortTheRayStartsAtTheCentre) {
  const Lens lens = make_lens(101, 51, 60);
  const auto ray = trace_pixel(lens, nullptr, 100, 25);
  ASSERT_TRUE(ray);
  EXPECT_EQ(ray->start, Vector3d::Zero());
  EXPECT_EQ(ray->on_axis, Vector3d::Zero());
  EXPECT_NEAR(ray->direction.x() / ray->direction.z(), 50 / lens.focal, 1e-15);
}

TEST(Optics, RefusesWhatNoHousingHas) {
  const Lens lens = make_lens(1024, 768, 80);
  const auto refused = [&](auto change) {
    Port port = kPaperPort;
    change(port);
    EXPECT_THROW(check_port(port, lens), Error);
  };
  EXPECT_NO_THROW(check_port(kPaperPort, lens));
  refused([](Port& p) { p.distance = -0.01; });
  refused([](Port& p) { p.distance = std::nan(""); });
  refused([](Port& p) { p.thickness = 2; });
  refused([](Port& p) { p.n_water = 0.9; });
  refused([](Port& p) { p.normal = tilted_normal(60); });
  EXPECT_THROW(make_lens(0, 10, 80), Error);
  EXPECT_THROW(make_lens(10, 10, 180), Error);
}

}  // namespace
}  // namespace axial::simulate
