// SPDX-License-Identifier: GPL-3.0-or-later
#include "refractive/virtual_camera.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "refractive/affine_warp.h"
#include "refractive/pixel_lookup.h"
#include "refractive/views.h"

namespace axial::refractive::testing {
namespace {

TEST(VirtualCamera, ShowsThePixelsRayAtThePixel) {
  Random random(81);
  for (int k = 0; k < 1000; ++k) {
    const View view = random_view(random);
    const auto camera = view.camera<double>();
    const Vector2<double> pixel = random_pixel(random, view);
    const AxialRay<double> ray = camera.ray(pixel);
    const VirtualCamera<double> virtual_one = virtual_camera(camera, pixel);
    for (const double distance : {0.3, 2.0, 9.0})
      EXPECT_LT((virtual_one.pixel(ray.at(distance)) - pixel).norm(), 1e-9);
    EXPECT_LT(virtual_one.centre.cross(view.port.normal).norm(), 1e-15);
    EXPECT_LT((virtual_one.rotation * view.port.normal - Vector3<double>::UnitZ()).norm(), 1e-14);
  }
}

TEST(VirtualCamera, IsThePinholeItselfWithoutRefraction) {
  View view{640, 480, lens_with_fov(70, 640, 480), paper_port()};
  view.port.n_glass = view.port.n_water = 1;
  const VirtualCamera<double> behind_port = virtual_camera(view.camera<double>(), {100, 7});
  const VirtualCamera<double> dry =
      virtual_camera(PinholeCamera<double>(view.lens), Vector2<double>(100, 7));
  EXPECT_LT((behind_port.centre - dry.centre).norm(), 1e-15);
  EXPECT_NEAR(behind_port.lens.cx, dry.lens.cx, 1e-10);
  EXPECT_NEAR(behind_port.lens.cy, dry.lens.cy, 1e-10);
}

struct Pair {
  View reference, source;
  Matrix3<double> R;
  Vector3<double> C;  // x_source = R (x_reference - C)
};

Pair random_pair(Random& random) {
  return {random_view(random), random_view(random),
          Eigen::AngleAxisd(random.uniform(-0.3, 0.3), random.unit_vector()).toRotationMatrix(),
          0.4 * random.unit_vector()};
}

// Eq. 1: the pose relates a point's coordinates in both virtual cameras.
TEST(RelativePose, TakesPointsFromOneVirtualCameraToTheOther) {
  Random random(82);
  for (int k = 0; k < 500; ++k) {
    const Pair pair = random_pair(random);
    const auto a = virtual_camera(pair.reference.camera<double>(), {300, 200});
    const auto b = virtual_camera(pair.source.camera<double>(), {500, 600});
    const auto pose = relative_pose(a, b, pair.R, pair.C);
    const Vector3<double> X = Vector3<double>(0, 0, 2) + random.unit_vector();
    const Vector3<double> in_a = a.rotation * (X - a.centre);
    const Vector3<double> in_b = b.rotation * (pair.R * (X - pair.C) - b.centre);
    EXPECT_LT((pose.rotation * (in_a - pose.centre) - in_b).norm(), 1e-13);
  }
}

// Eq. 2: the homography maps the image of every point of the plane in one virtual camera to its
// image in the other.
TEST(VirtualHomography, MapsTheImagesOfThePlane) {
  Random random(83);
  for (int k = 0; k < 500; ++k) {
    const Pair pair = random_pair(random);
    const auto a = virtual_camera(pair.reference.camera<double>(), {300, 200});
    const auto b = virtual_camera(pair.source.camera<double>(), {500, 600});
    const Vector3<double> X(0.2, -0.1, 2.5);
    const Vector3<double> n = (-Vector3<double>::UnitZ() + 0.5 * random.unit_vector()).normalized();
    const Matrix3<double> H = virtual_homography(a, b, pair.R, pair.C, X, n);
    for (int i = 0; i < 5; ++i) {
      const Vector3<double> Y = X + 0.5 * n.cross(random.unit_vector());
      const Vector2<double> expected = b.pixel(pair.R * (Y - pair.C));
      EXPECT_LT((apply_homography(H, a.pixel(Y)) - expected).norm(), 1e-8);
    }
  }
}

// Without refraction and without tilt the paper's warp is exact, and the affine warp is its
// first-order approximation. With a tilt the paper's warp is not exact, because the image plane of
// the virtual camera is parallel to the port and not to the image plane of the lens.
TEST(VirtualHomography, IsTheExactWarpWhenAllIndicesAreOne) {
  Random random(84);
  for (int k = 0; k < 500; ++k) {
    Pair pair = random_pair(random);
    for (View* view : {&pair.reference, &pair.source}) {
      view->port.n_air = view->port.n_glass = view->port.n_water = 1;
      view->port.normal = Vector3<double>::UnitZ();
    }
    const auto reference = pair.reference.camera<double>();
    const auto source = pair.source.camera<double>();
    const Vector2<double> p = random_pixel(random, pair.reference);
    const Vector3<double> n = (-Vector3<double>::UnitZ() + 0.3 * random.unit_vector()).normalized();
    const AxialRay<double> ray = reference.ray(p);
    const double distance = random.uniform(1, 4);
    const Vector3<double> X = ray.at(distance);
    const auto image = source.project(pair.R * (X - pair.C));
    if (!image.visible) continue;
    const Matrix3<double> H = virtual_homography(
        virtual_camera(reference, p), virtual_camera(source, image.pixel), pair.R, pair.C, X, n);
    const auto affine = affine_warp(reference, source, pair.R, pair.C, p, distance, n);
    for (int i = 0; i < 5; ++i) {
      const Vector2<double> q = p + 4 * random.unit_vector().head<2>();
      const AxialRay<double> other = reference.ray(q);
      const double there = plane_intersection(other, X, n);
      const auto exact = source.project(pair.R * (other.at(there) - pair.C));
      if (!exact.visible) continue;
      EXPECT_LT((apply_homography(H, q) - exact.pixel).norm(), 1e-8);
      // The second-order part of the warp over 4 px in an image of 1024 px.
      EXPECT_LT((affine(q) - exact.pixel).norm(), 1e-2 * (exact.pixel - image.pixel).norm() + 0.3);
    }
    const double h = 1e-3;
    for (int i = 0; i < 2; ++i) {
      const Vector2<double> step = Vector2<double>::Unit(i) * h;
      const Vector2<double> slope = (apply_homography(H, Vector2<double>(p + step)) -
                                     apply_homography(H, Vector2<double>(p - step))) /
                                    (2 * h);
      EXPECT_LT((affine.linear.col(i) - slope).norm(), 1e-6 * affine.linear.norm());
    }
  }
}

TEST(PixelLookup, HoldsTheRaysAndPrincipalPoints) {
  Random random(86);
  const View view = random_view(random, 64, 48);
  const auto camera = view.camera<double>();
  const PixelLookup<double> lookup(camera, 64, 48);
  for (int v = 0; v < 48; v += 5) {
    for (int u = 0; u < 64; u += 5) {
      const Vector2<double> pixel(u, v);
      const Vector2<double> near = pixel + Vector2<double>(0.4, -0.4);
      const auto entry = lookup.entry(near);
      const auto expected = virtual_camera(camera, pixel);
      const AxialRay<double> ray = camera.ray(pixel);
      EXPECT_LT((entry.centre - ray.origin).norm(), 1e-15);
      EXPECT_LT((entry.direction - ray.direction).norm(), 1e-15);
      EXPECT_LT(
          (entry.principal_point - Vector2<double>(expected.lens.cx, expected.lens.cy)).norm(),
          1e-9);
    }
  }
}

TEST(PixelLookup, RoundsAndClamps) {
  const View view{64, 48, lens_with_fov(80, 64, 48), paper_port()};
  const PixelLookup<float> lookup(view.camera<float>(), 64, 48);
  const auto expect = [&](Vector2<float> pixel, int u, int v) {
    const IntegerPixel p = lookup.round(pixel);
    EXPECT_EQ(p.u, u) << pixel.transpose();
    EXPECT_EQ(p.v, v) << pixel.transpose();
  };
  expect({3.4f, 7.6f}, 3, 8);
  expect({-0.7f, 47.4f}, 0, 47);
  expect({63.9f, 48.9f}, 63, 47);
  expect({1e30f, -1e30f}, 63, 0);
  expect({NAN, NAN}, 0, 0);
}

}  // namespace
}  // namespace axial::refractive::testing
