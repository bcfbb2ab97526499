// SPDX-License-Identifier: GPL-3.0-or-later
// Compares lens models with OpenCV's projection where OpenCV has the model, otherwise with the
// defining equation.
#include "lens/lens.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <random>

#include "io/colmap/colmap_lens.h"
#include "lens/lens_cameras.h"
#include "lens/lens_fit.h"
#include "refractive/distorted_lens.h"

namespace axial::lens {
namespace {

using Eigen::Vector2d;
using io::ColmapCamera;
using io::lens_of;

// Both sides evaluate the same polynomial in double, so 1e-9 px allows for rounding.
constexpr double kRounding = 1e-9;

RC_GTEST_PROP(Lens, FullOpencvAgreesWithOpencv, ()) {
  const double u = within(1), v = within(1);
  std::vector<double> k;
  for (int i = 0; i < 8; ++i) k.push_back(within(i == 2 || i == 3 ? 0.01 : 0.1));
  // Rounding is large near a zero of the denominator, where the lens images nothing.
  const double r2 = u * u + v * v;
  RC_PRE(1 + r2 * (k[5] + r2 * (k[6] + r2 * k[7])) > 0.1);
  std::vector<cv::Point2d> expected;
  cv::projectPoints(std::vector<cv::Point3d>{{u, v, 1}}, cv::Vec3d(), cv::Vec3d(), opencv_k(), k,
                    expected);
  const Vector2d pixel = image_direction(lens_of(two_focal_camera("FULL_OPENCV", k)), u, v);
  RC_ASSERT(std::abs(pixel.x() - expected[0].x) < kRounding);
  RC_ASSERT(std::abs(pixel.y() - expected[0].y) < kRounding);
  k.resize(4);
  cv::projectPoints(std::vector<cv::Point3d>{{u, v, 1}}, cv::Vec3d(), cv::Vec3d(), opencv_k(), k,
                    expected);
  const Vector2d shorter = image_direction(lens_of(two_focal_camera("OPENCV", k)), u, v);
  RC_ASSERT(std::abs(shorter.x() - expected[0].x) < kRounding);
  RC_ASSERT(std::abs(shorter.y() - expected[0].y) < kRounding);
}

RC_GTEST_PROP(Lens, FisheyesAgreeWithOpencv, ()) {
  const double u = within(2), v = within(2);
  std::vector<double> k{within(0.1), within(0.1), within(0.1), within(0.1)};
  std::vector<cv::Point2d> expected;
  cv::fisheye::projectPoints(std::vector<cv::Point3d>{{u, v, 1}}, expected, cv::Vec3d(),
                             cv::Vec3d(), opencv_k(), k);
  const Vector2d reference(expected[0].x, expected[0].y);
  const auto agrees = [&](const ColmapCamera& camera) {
    return (image_direction(lens_of(camera), u, v) - reference).norm() < kRounding;
  };
  RC_ASSERT(agrees(two_focal_camera("OPENCV_FISHEYE", k)));
  RC_ASSERT(agrees(two_focal_camera("THIN_PRISM_FISHEYE", {k[0], k[1], 0, 0, k[2], k[3], 0, 0})));
  RC_ASSERT(agrees(two_focal_camera("RAD_TAN_THIN_PRISM_FISHEYE",
                                    {k[0], k[1], k[2], k[3], 0, 0, 0, 0, 0, 0, 0, 0})));
}

RC_GTEST_PROP(Lens, DefiningEquationsHold, ()) {
  const double u = within(1), v = within(1), r = std::hypot(u, v);
  const double k = within(0.1);
  RC_PRE(r > 1e-6);
  const Vector2d division = distorted(one_focal_camera("SIMPLE_DIVISION", {k}), u, v);
  RC_ASSERT(std::abs(division.norm() / (1 + k * division.squaredNorm()) - r) < 1e-12);
  const double omega = 0.9 + k;
  const Vector2d fov = distorted(two_focal_camera("FOV", {omega}), u, v);
  RC_ASSERT(std::abs(std::tan(fov.norm() * omega) / (2 * std::tan(omega / 2)) - r) < 1e-12);
  const double alpha = 0.5 + k;
  const Vector2d eucm = distorted(two_focal_camera("EUCM", {alpha, 1.0}), u, v);
  // beta = 1 is the unified model: a sphere whose projection centre is xi behind its centre, with
  // xi = alpha/(1-alpha).
  const double xi = alpha / (1 - alpha), length = std::sqrt(r * r + 1);
  RC_ASSERT(std::abs(eucm.x() - (1 + xi) * (u / length) / (1 / length + xi)) < 1e-12);
  const double theta = std::atan(r);
  RC_ASSERT(std::abs(distorted(one_focal_camera("SIMPLE_FISHEYE", {}), u, v).norm() - theta) <
            1e-12);
}

// Every model of which the matcher's form is exact is found again: it images all directions alike.
RC_GTEST_PROP(Lens, ModelOfTheMatchersForm, ()) {
  const double u = within(0.7), v = within(0.7);
  const auto k = [] { return within(0.05); };
  const std::vector<std::pair<const char*, std::vector<double>>> lenses{
      {"RADIAL", {k(), k()}},
      {"OPENCV", {k(), k(), k(), k()}},
      {"FULL_OPENCV", {k(), k(), k(), k(), k(), k(), k(), k()}},
      {"RADIAL_FISHEYE", {k(), k()}},
      {"OPENCV_FISHEYE", {k(), k(), k(), k()}},
      {"THIN_PRISM_FISHEYE", {k(), k(), k(), k(), k(), k(), k(), k()}},
      {"FOV", {0.9 + k()}}};
  for (const auto& [name, parameters] : lenses) {
    const Model* const model = find_model(name);
    auto bent = model->bent(parameters);
    const auto found = model_of(bent);
    RC_ASSERT(found.has_value());
    RC_ASSERT(found->focal_factor == 1);
    const Vector2d expected = model->distort(parameters, {u, v}).point;
    const Vector2d again = find_model(found->name)->distort(found->parameters, {u, v}).point;
    RC_ASSERT((again - expected).norm() < 1e-12);
    // A lens with a first coefficient that is not 1 moves it into the focal lengths.
    for (double& a : bent.above) a *= 2;
    bent.p1 *= 2;
    bent.p2 *= 2;
    bent.prism *= 2;
    const auto doubled = model_of(bent);
    RC_ASSERT(doubled.has_value());
    RC_ASSERT(std::abs(doubled->focal_factor - 2) < 1e-12);
    RC_ASSERT(doubled->name == found->name);
  }
}

TEST(Lens, NoModelOfFormsThatColmapLacks) {
  refractive::LensDistortion<double> bent;
  bent.prism = {0.01, 0};
  EXPECT_FALSE(model_of(bent)) << "a thin prism of a perspective lens";
  bent = {};
  bent.fisheye = 1;
  bent.below[0] = 0.1;
  EXPECT_FALSE(model_of(bent)) << "a ratio of a fisheye";
  bent = {};
  bent.fisheye = 1;
  bent.spread = 0.8;
  bent.above[1] = 0.1;
  EXPECT_FALSE(model_of(bent)) << "a polynomial with a spread";
}

TEST(Lens, PinholesAreTakenAsTheyAre) {
  const auto lens = pinhole_lens(lens_of(two_focal_camera("PINHOLE", {})));
  ASSERT_TRUE(lens);
  EXPECT_EQ(lens->fx, kFx);
  EXPECT_EQ(lens->fy, kFy);
  EXPECT_EQ(lens->cx, kCx - 0.5);
  EXPECT_EQ(lens->cy, kCy - 0.5);
  const auto simple = pinhole_lens(lens_of(one_focal_camera("SIMPLE_RADIAL", {0.0})));
  ASSERT_TRUE(simple);
  EXPECT_EQ(simple->fy, kFx);
  EXPECT_FALSE(pinhole_lens(lens_of(one_focal_camera("SIMPLE_RADIAL", {1e-9}))));
  EXPECT_FALSE(pinhole_lens(lens_of(two_focal_camera("OPENCV_FISHEYE", {0, 0, 0, 0}))));
}

// In the sanitized build, a lens that referred to its camera's memory would end this test.
TEST(Lens, OutlivesItsCamera) {
  const Lens lens = lens_of(two_focal_camera("OPENCV", {-0.1, 0.02, 1e-3, -2e-3}));
  const ColmapCamera camera = two_focal_camera("OPENCV", {-0.1, 0.02, 1e-3, -2e-3});
  EXPECT_EQ(lens.distortion, (std::vector<double>{-0.1, 0.02, 1e-3, -2e-3}));
  EXPECT_EQ(image_direction(lens, 0.3, -0.2), image_direction(lens_of(camera), 0.3, -0.2));
}

// Each lens costs a search of 0.4 s with the sanitizers, so there are fewer than RapidCheck's 100.
TEST(Lens, NoPixelOfTheUndistortedImageIsEmpty) {
  std::mt19937 random(1);
  const auto drawn = [&](double limit) {
    return std::uniform_real_distribution<double>(-limit, limit)(random);
  };
  for (int draw = 0; draw < 16; ++draw) {
    const ColmapCamera camera{
        1,
        "OPENCV",
        80,
        60,
        {87.5, 80, 41, 29.5, drawn(0.3), drawn(0.05), drawn(0.002), drawn(0.002)}};
    const auto lens = pinhole_inside(lens_of(camera)).value();
    double nearest = 1e9;  // distance to the border of the photograph, negative outside of it
    const cv::Mat2f map = undistortion_map(lens_of(camera), lens);
    for (int y = 0; y < map.rows; ++y)
      for (int x = 0; x < map.cols; ++x) {
        const cv::Vec2f p = map(y, x);
        nearest = std::min<double>({nearest, p[0], p[1], 79 - p[0], 59 - p[1]});
      }
    // pinhole_inside checks 64 positions on each side; between them the border may bulge a little.
    EXPECT_GT(nearest, -0.1) << draw;
    // The pinhole is zoomed out as far as possible: some pixel touches the border of the
    // photograph.
    EXPECT_LT(nearest, 0.1) << draw;
  }
}

RC_GTEST_PROP(Lens, DirectionsAreFoundAgain, ()) {
  const std::vector<ColmapCamera> cameras{
      two_focal_camera("PINHOLE", {}),
      one_focal_camera("SIMPLE_RADIAL", {-0.1}),
      one_focal_camera("RADIAL", {-0.1, 0.02}),
      two_focal_camera("OPENCV", {-0.1, 0.02, 1e-3, -1e-3}),
      two_focal_camera("FULL_OPENCV", {-0.1, 0.02, 1e-3, -1e-3, 0.01, 0.02, 0.01, 0}),
      two_focal_camera("OPENCV_FISHEYE", {0.02, -0.01, 0.002, 0}),
      one_focal_camera("SIMPLE_RADIAL_FISHEYE", {0.02}),
      two_focal_camera("THIN_PRISM_FISHEYE", {0.02, -0.01, 1e-3, 1e-3, 0, 0, 1e-3, 1e-3})};
  const double u = within(0.6), v = within(0.6);
  for (const ColmapCamera& camera : cameras) {
    const auto found = direction_at(lens_of(camera), image_direction(lens_of(camera), u, v));
    RC_ASSERT(found.has_value());
    RC_ASSERT((found->direction - Vector2d(u, v)).norm() < 1e-9);
    const double h = 1e-5;
    const Vector2d slope =
        (image_direction(lens_of(camera), u + h, v) - image_direction(lens_of(camera), u - h, v)) /
        (2 * h);
    RC_ASSERT((found->derivative.col(0) - slope).norm() < 1e-4 * slope.norm());
  }
}

// Central differences of the points are good to about 1e-9 of the derivative.
RC_GTEST_PROP(Lens, DerivativesAreThoseOfCentralDifferences, ()) {
  const std::vector<ColmapCamera> cameras{
      one_focal_camera("SIMPLE_PINHOLE", {}),
      two_focal_camera("PINHOLE", {}),
      one_focal_camera("SIMPLE_RADIAL", {-0.1}),
      one_focal_camera("RADIAL", {-0.1, 0.02}),
      two_focal_camera("OPENCV", {-0.1, 0.02, 1e-2, -2e-2}),
      two_focal_camera("FULL_OPENCV", {-0.1, 0.02, 1e-2, -2e-2, 0.01, 0.02, 0.03, 0.004}),
      two_focal_camera("OPENCV_FISHEYE", {0.02, -0.01, 0.002, 0.001}),
      one_focal_camera("SIMPLE_RADIAL_FISHEYE", {0.02}),
      one_focal_camera("RADIAL_FISHEYE", {0.02, -0.01}),
      one_focal_camera("SIMPLE_FISHEYE", {}),
      two_focal_camera("FISHEYE", {}),
      two_focal_camera("THIN_PRISM_FISHEYE", {0.02, -0.01, 1e-2, 2e-2, 0.003, 1e-3, 4e-2, 5e-2}),
      two_focal_camera("RAD_TAN_THIN_PRISM_FISHEYE",
                       {0.02, -0.01, 3e-3, 2e-3, 1e-3, 1e-3, 1e-2, 2e-2, 4e-2, 3e-2, 5e-2, 2e-2}),
      two_focal_camera("FOV", {0.9}),
      one_focal_camera("SIMPLE_DIVISION", {-0.2}),
      two_focal_camera("DIVISION", {0.1}),
      two_focal_camera("EUCM", {0.6, 1.1})};
  const Vector2d at(within(0.7), within(0.7));
  for (const ColmapCamera& camera : cameras) {
    const Lens lens = lens_of(camera);
    const auto image = image_with_derivative(lens, at);
    RC_ASSERT(image.point == image_direction(lens, at.x(), at.y()));
    for (int k = 0; k < 2; ++k) {
      const Vector2d step = 1e-5 * Vector2d::Unit(k), ahead = at + step, behind = at - step;
      const Vector2d slope = (image_direction(lens, ahead.x(), ahead.y()) -
                              image_direction(lens, behind.x(), behind.y())) /
                             2e-5;
      RC_ASSERT((image.by.col(k) - slope).norm() < 1e-8 * image.by.norm());
    }
  }
}

TEST(Lens, HasItsDerivativeOnTheAxis) {
  for (const ColmapCamera& camera :
       {two_focal_camera("FISHEYE", {}), two_focal_camera("EUCM", {0.6, 1.1})}) {
    const auto image = image_with_derivative(lens_of(camera), Vector2d::Zero());
    EXPECT_LT((image.by - Vector2d(kFx, kFy).asDiagonal().toDenseMatrix()).norm(), 1e-9);
  }
  const auto spread = image_with_derivative(lens_of(two_focal_camera("FOV", {0.9})), {0, 0});
  EXPECT_NEAR(spread.by(0, 0), kFx * 2 * std::tan(0.45) / 0.9, 1e-9);
}

// The field ends where the derivative of r (1 + k1 r^2 + k2 r^4) is zero.
TEST(Lens, TheFieldEndsAtTheFold) {
  const auto reach = [](const ColmapCamera& camera) { return field_of(lens_of(camera)).reach; };
  EXPECT_NEAR(reach(one_focal_camera("RADIAL", {-0.5, 0.1})), 1, 1e-6);
  EXPECT_NEAR(reach(one_focal_camera("SIMPLE_RADIAL", {-0.5})), std::sqrt(2.0 / 3), 1e-6);
  EXPECT_GT(reach(two_focal_camera("PINHOLE", {})), 1e5);
  EXPECT_GT(reach(two_focal_camera("OPENCV_FISHEYE", {0, 0, 0, 0})), 1e5);
}

TEST(Lens, TheFieldKnowsTheFarthestCorner) {
  const Field field = field_of(lens_of(two_focal_camera("PINHOLE", {})));
  EXPECT_NEAR(field.corner, std::hypot((kCx - 0.5) / kFx, (479 - kCy + 0.5) / kFy), 1e-2);
  const Field folded = field_of(lens_of(one_focal_camera("RADIAL", {-0.9, 0.1})));
  EXPECT_EQ(folded.corner, folded.reach);
}

TEST(Lens, DirectionsWithinTheFieldAreThoseOfTheSearch) {
  for (const ColmapCamera& camera :
       {one_focal_camera("RADIAL", {-0.5, 0.1}), two_focal_camera("PINHOLE", {}),
        two_focal_camera("OPENCV", {-0.4, 0.02, 1e-3, -1e-3}),
        two_focal_camera("THIN_PRISM_FISHEYE", {0.02, -0.1, 1e-3, 1e-3, 0, 0, 1e-3, 1e-3})}) {
    const Lens lens = lens_of(camera);
    const Field field = field_of(lens);
    for (double x = 0; x < 640; x += 20)
      for (double y = 0; y < 480; y += 20) {
        const auto searched = direction_at(lens, {x, y}), found = direction_at(lens, field, {x, y});
        ASSERT_EQ(searched.has_value(), found.has_value()) << camera.model << " " << x << " " << y;
        if (found) {
          EXPECT_EQ(found->direction, searched->direction);
        }
      }
  }
}

// Differences between the matcher's lens and the model: the image of (u, v) [px], and the direction
// found from that image.
struct Misses {
  double pixel = 0, direction = 0;
};

// A lens, and the matcher's form of it, whose fit takes long.
struct FittedLens {
  Lens lens;
  refractive::DistortedLens<double> matchers;

  explicit FittedLens(const ColmapCamera& camera)
      : lens(lens_of(camera)),
        matchers(lens.pinhole, lens_distortion(lens).value(), 640, 480, 400) {}
};

std::vector<FittedLens> fitted(const std::vector<ColmapCamera>& cameras) {
  return {cameras.begin(), cameras.end()};
}

Misses misses_of_the_matcher(const FittedLens& fitted, double u, double v) {
  const auto seen = fitted.matchers.project({u, v});
  RC_ASSERT(seen.projection.visible);
  const Vector2d pixel = seen.projection.pixel;
  return {(pixel - image_direction(fitted.lens, u, v)).norm(),
          (fitted.matchers.tangents(pixel).point - Vector2d(u, v)).norm()};
}

// The matcher's formula and the models share no code.
RC_GTEST_PROP(Lens, TheMatchersLensesImageTheSame, ()) {
  static const std::vector<FittedLens> lenses = fitted(
      {one_focal_camera("SIMPLE_RADIAL", {-0.1}), one_focal_camera("RADIAL", {-0.1, 0.02}),
       two_focal_camera("OPENCV", {-0.1, 0.02, 1e-3, -2e-3}),
       two_focal_camera("FULL_OPENCV", {-0.1, 0.02, 1e-3, -2e-3, 0.01, 0.02, 0.03, 0.004}),
       two_focal_camera("OPENCV_FISHEYE", {0.02, -0.01, 0.002, 0.001}),
       one_focal_camera("SIMPLE_RADIAL_FISHEYE", {0.02}),
       one_focal_camera("RADIAL_FISHEYE", {0.02, -0.01}), one_focal_camera("SIMPLE_FISHEYE", {}),
       two_focal_camera("FISHEYE", {}),
       two_focal_camera("THIN_PRISM_FISHEYE", {0.02, -0.01, 1e-3, 2e-3, 0.003, 1e-3, 4e-3, 5e-3}),
       two_focal_camera("FOV", {0.9})});
  const double u = within(0.7), v = within(0.7);
  for (const FittedLens& lens : lenses) {
    const Misses misses = misses_of_the_matcher(lens, u, v);
    RC_ASSERT(misses.pixel < kRounding);
    RC_ASSERT(misses.direction < kRounding);
  }
}

// The fit is accurate to 1e-4 px along both focal lengths, which is 1.5e-7 of a focal length. A
// pixel at the edge of these lenses covers up to three times the angle of a central one.
RC_GTEST_PROP(Lens, TheMatcherFollowsLensesThatAreNoPolynomials, ()) {
  static const std::vector<FittedLens> lenses =
      fitted({one_focal_camera("SIMPLE_DIVISION", {-0.2}), two_focal_camera("DIVISION", {-1}),
              two_focal_camera("DIVISION", {0.1}), two_focal_camera("EUCM", {0.6, 1.1}),
              two_focal_camera("EUCM", {0.5, 1})});
  const double u = within(0.4), v = within(0.3);
  for (const FittedLens& lens : lenses) {
    const Misses misses = misses_of_the_matcher(lens, u, v);
    RC_ASSERT(misses.pixel < 1.5e-4);
    RC_ASSERT(misses.direction < 5e-7);
  }
}

TEST(Lens, TheMatcherHasNoLensForOtherModels) {
  for (const ColmapCamera& camera :
       {two_focal_camera("RAD_TAN_THIN_PRISM_FISHEYE", std::vector<double>(12, 0.001)),
        two_focal_camera("PINHOLE", {}), two_focal_camera("OPENCV", {0, 0, 0, 0}),
        two_focal_camera("FOV", {0}),
        // This lens images nothing beyond half a focal length, where the image corners are.
        two_focal_camera("DIVISION", {4})})
    EXPECT_FALSE(lens_distortion(lens_of(camera))) << camera.model;
}

TEST(Lens, AFitThatMissesIsNoLens) {
  const double widest = 1, tolerance = 1e-4;
  const auto smooth = [](double theta) { return std::sin(theta); };
  const auto with_a_kink = [](double theta) { return std::min(theta, 0.5 + 0.3 * (theta - 0.5)); };
  EXPECT_TRUE(fitted_fisheye(smooth, widest, tolerance));
  EXPECT_FALSE(fitted_fisheye(with_a_kink, widest, tolerance));
}

// At the edge of a fisheye's field, directions are far out on the plane z = 1.
TEST(Lens, DirectionsAtAFisheyesEdgeAreFound) {
  const ColmapCamera camera = two_focal_camera("OPENCV_FISHEYE", {0, 0, 0, 0});
  for (const double degrees : {60.0, 80.0, 88.0}) {
    const double u = std::tan(degrees * M_PI / 180);
    const auto found = direction_at(lens_of(camera), image_direction(lens_of(camera), u, 0));
    ASSERT_TRUE(found) << degrees;
    EXPECT_NEAR(found->direction.x() / u, 1, 1e-6) << degrees;
  }
}

TEST(Lens, NoDirectionIsFoundBeyondTheFold) {
  // This lens images nothing between 0.6 and the radius where the polynomial rises again.
  const ColmapCamera camera = one_focal_camera("RADIAL", {-0.5, 0.1});
  const Vector2d centre = image_direction(lens_of(camera), 0, 0);
  EXPECT_TRUE(direction_at(lens_of(camera), centre + Vector2d(0.5 * kFx, 0)));
  EXPECT_FALSE(direction_at(lens_of(camera), centre + Vector2d(0.65 * kFx, 0)));
  EXPECT_TRUE(direction_at(lens_of(camera), centre));
}

TEST(Lens, LensesThatFoldBackAreNotFollowedPastTheFold) {
  // The lens folds back at r = 0.816, and the image corners of this focal length are beyond that
  // radius.
  ColmapCamera camera{7, "SIMPLE_RADIAL", 640, 480, {300, 320, 240, -0.5}};
  const auto lens = pinhole_inside(lens_of(camera)).value();
  EXPECT_LT(std::hypot(319.5 / lens.fx, 239.5 / lens.fy), 0.8165);
}

}  // namespace
}  // namespace axial::lens
