// SPDX-License-Identifier: GPL-3.0-or-later
// Compares the port of a water surface with rays of light that cross the surface in the world
// frame.
#include "scene/water_surface.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "drawn.h"
#include "refractive/flat_port_camera.h"
#include "scene/camera_model.h"
#include "support/error_of.h"

namespace axial {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double between(double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(engine_);
  }
  Vector3d direction() {
    std::normal_distribution<double> normal;
    return axial::test::drawn<3>(normal, engine_).normalized();
  }

 private:
  std::mt19937_64 engine_;
};

// The camera of a drone above a water surface of any orientation. The camera is 0.2 to 50 m above
// the surface and up to 60 degrees inclined.
struct Flight {
  WaterSurface surface;
  Pose pose;
  CameraModel camera;

  refractive::FlatPortCamera<double> seen() const {
    CameraModel model = camera;
    model.port = port_seen_from(pose, surface, "a.jpg");
    return std::get<refractive::FlatPortCamera<double>>(make_camera<double>(model));
  }
};

Flight any_flight(Random& random) {
  Flight flight;
  flight.surface = {random.direction(), 10 * random.direction(), 1.00028,
                    random.between(1.32, 1.36)};
  const Vector3d& down = flight.surface.normal;
  const Vector3d aside = down.cross(random.direction()).normalized();
  const double height = std::exp(random.between(std::log(0.2), std::log(50)));
  flight.pose.centre = flight.surface.point + random.between(-20, 20) * aside - height * down;
  const double incline = random.between(0, 60) * M_PI / 180;
  const Vector3d z = Eigen::AngleAxisd(incline, aside) * down;
  const Vector3d x = z.cross(random.direction()).normalized();
  flight.pose.rotation.row(0) = x;
  flight.pose.rotation.row(1) = z.cross(x);
  flight.pose.rotation.row(2) = z;
  flight.camera = {640, 480, {500, 510, 315, 244}, {}};
  return flight;
}

// The point at which light from the camera centre to X crosses the surface. It lies on the line
// between the feet of both points, and is found by bisection of Snell's law.
Vector3d crossing(const WaterSurface& surface, const Vector3d& centre, const Vector3d& X) {
  const double above = surface.height_of(centre), below = -surface.height_of(X);
  const Vector3d foot = centre + above * surface.normal;
  const Vector3d across = X - below * surface.normal - foot;
  double low = 0, high = 1;
  for (int step = 0; step < 60; ++step) {
    const double t = (low + high) / 2;
    const double in_air = t * across.norm(), in_water = (1 - t) * across.norm();
    const bool too_far = surface.n_air * in_air / std::hypot(in_air, above) >
                         surface.n_water * in_water / std::hypot(in_water, below);
    (too_far ? high : low) = t;
  }
  return foot + low * across;
}

// A point in the water that the pinhole would see without refraction. So the test uses no ray of
// refractive/.
Vector3d any_point(Random& random, const Flight& flight) {
  const CameraModel& camera = flight.camera;
  const Vector3d bearing = camera.lens.bearing(
      {random.between(0, camera.width - 1), random.between(0, camera.height - 1)});
  const Vector3d towards = flight.pose.rotation.transpose() * bearing;
  const double sink = towards.dot(flight.surface.normal);
  const double height_above = flight.surface.height_of(flight.pose.centre);
  if (sink < 0.05) return flight.pose.centre;
  return flight.pose.centre + (height_above / sink) * random.between(1.001, 3) * towards;
}

TEST(WaterSurface, ProjectsAsLightThatCrossesThePlane) {
  Random random(1);
  int tested = 0;
  for (int k = 0; k < 1000; ++k) {
    const Flight flight = any_flight(random);
    const Vector3d X = any_point(random, flight);
    const auto camera = flight.seen();
    const auto image = camera.project(flight.pose.to_camera(X));
    if (!image.visible) continue;
    ++tested;
    const Vector3d entry = crossing(flight.surface, flight.pose.centre, X);
    const auto expected = flight.camera.lens.pixel(flight.pose.to_camera(entry));
    // The rounding of distances of 100 m is 1e-14 m and causes errors of 1e-12 px. The oracle loses
    // some more digits.
    EXPECT_LT((image.pixel - expected).norm(), 1e-9);
    EXPECT_LT((flight.pose.to_world(camera.exit_point(image.pixel)) - entry).norm(), 1e-10);
    const auto ray = camera.ray(image.pixel);
    const Vector3d in_water = flight.pose.rotation.transpose() * ray.direction;
    const Vector3d way = X - entry;
    EXPECT_LT(in_water.cross(way).norm(), 1e-9);
    EXPECT_GT(in_water.dot(way), 0);
  }
  EXPECT_GT(tested, 500);  // refraction moves some points out of the image
}

// No visible point in the water lies behind a camera whose axis meets the surface. Depth maps rely
// on this property.
TEST(WaterSurface, SeesOnlyWhatIsBeforeTheCamera) {
  Random random(2);
  int seen = 0;
  for (int k = 0; k < 1000; ++k) {
    const Flight flight = any_flight(random);
    const double height = flight.surface.height_of(flight.pose.centre);
    const Vector3d X = flight.pose.centre + 3 * height * random.direction();
    if (!flight.seen().project(flight.pose.to_camera(X)).visible) continue;
    EXPECT_LT(flight.surface.height_of(X), 0);
    EXPECT_GT(flight.pose.to_camera(X).z(), 0);
    ++seen;
  }
  EXPECT_GT(seen, 10);
}

TEST(WaterSurface, IsTheSamePortWhereverTheWorldIs) {
  Random random(3);
  for (int k = 0; k < 100; ++k) {
    const Flight flight = any_flight(random);
    const Eigen::Matrix3d turn(Eigen::AngleAxisd(random.between(0, 3), random.direction()));
    const Vector3d shift = 5 * random.direction();
    // The result is the same for another point of the plane.
    const Vector3d in_plane = flight.surface.normal.cross(random.direction());
    WaterSurface moved = flight.surface;
    moved.normal = turn * flight.surface.normal;
    moved.point = turn * (flight.surface.point + 3 * in_plane) + shift;
    const Pose pose{flight.pose.rotation * turn.transpose(), turn * flight.pose.centre + shift};
    const auto port = port_seen_from(flight.pose, flight.surface, "");
    const auto again = port_seen_from(pose, moved, "");
    EXPECT_LT((again.normal - port.normal).norm(), 1e-14);
    EXPECT_NEAR(again.distance, port.distance, 1e-13);
    EXPECT_EQ(port.thickness, 0);
    EXPECT_EQ(port.n_water, flight.surface.n_water);
  }
}

// A camera at x = 0 and z = `height` that looks down at the water at z = 1, rotated about its x
// axis.
Pose above(double height, double incline_degrees) {
  Pose pose;
  pose.rotation = Eigen::AngleAxisd(incline_degrees * M_PI / 180, Vector3d::UnitX()) *
                  Vector3d(1, -1, -1).asDiagonal();
  pose.centre.z() = height;
  return pose;
}

TEST(WaterSurface, RefusesCamerasThatDoNotLookIntoTheWater) {
  const WaterSurface lake{{0, 0, -1}, {7, 7, 1}, 1, 1.333};
  const auto error = [&](double height, double incline) {
    return test::error_of([&] { port_seen_from(above(height, incline), lake, "a.jpg"); });
  };
  EXPECT_EQ(port_seen_from(above(3, 0), lake, "a.jpg").distance, 2);
  EXPECT_EQ(port_seen_from(above(3, 0), lake, "a.jpg").normal, Vector3d::UnitZ());
  EXPECT_THAT(error(0.5, 0),
              HasSubstr("a.jpg: the camera's height over the water surface is -0.5"));
  EXPECT_THAT(error(1, 0), HasSubstr("is 0 m"));
  EXPECT_THAT(error(std::nan(""), 0), HasSubstr("is nan m"));
  EXPECT_THAT(error(3, 91), HasSubstr("a.jpg: the camera looks away from the water surface: 91.0"));
  EXPECT_THAT(error(3, 180), HasSubstr("180.0 degrees"));
  EXPECT_NO_THROW(port_seen_from(above(3, 89), lake, "a.jpg"));
}

}  // namespace
}  // namespace axial
