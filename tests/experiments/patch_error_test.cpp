// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/patch_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "experiments/scaled_virtual_camera.h"

namespace axial::experiments {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

// The distance from the axis at which a light ray from the lens, traced by Snell's law with angles,
// reaches the height z [axis frame].
double traced_radius(const CameraSetup& setup, double angle, double z) {
  const double glass = std::asin(std::sin(angle) / setup.n_glass);
  const double water = std::asin(std::sin(angle) / setup.n_water);
  return setup.distance * std::tan(angle) + setup.thickness * std::tan(glass) +
         (z - setup.distance - setup.thickness) * std::tan(water);
}

// Forward projection by bisection of the angle, for a port without tilt.
Vector2<double> traced_image(const CameraSetup& setup, const PinholeLens<double>& lens,
                             const Vector3<double>& X) {
  const double rho = std::hypot(X.x(), X.y());
  double low = 0, high = 85 * kDegree;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (traced_radius(setup, middle, X.z()) < rho ? low : high) = middle;
  }
  const double scale = std::tan(low) / rho;
  return lens.pixel({X.x() * scale, X.y() * scale, 1});
}

// The point of the plane z = 4 on the pixel's ray.
Vector3<double> traced_point(const CameraSetup& setup, const PinholeLens<double>& lens,
                             const Vector2<double>& pixel) {
  const Vector3<double> air = lens.bearing(pixel);
  const double rho = std::hypot(air.x(), air.y());
  const double k = traced_radius(setup, std::atan(rho), 4) / rho;
  return {k * air.x(), k * air.y(), 4};
}

// A pinhole with its centre on the z axis that has the same ray at the same pixel.
struct TracedVirtualCamera {
  double height, f;
  Vector2<double> c;

  TracedVirtualCamera(const CameraSetup& setup, const PinholeLens<double>& lens,
                      const Vector2<double>& pixel)
      : f(lens.fx) {
    const Vector3<double> X = traced_point(setup, lens, pixel);
    const Vector3<double> air = lens.bearing(pixel);
    const double sine = std::sin(std::atan(std::hypot(air.x(), air.y()))) / setup.n_water;
    height = 4 - std::hypot(X.x(), X.y()) / std::tan(std::asin(sine));
    c = pixel - f * X.head<2>() / (X.z() - height);
  }
  Vector2<double> image(const Vector3<double>& X) const {
    return f * X.head<2>() / (X.z() - height) + c;
  }
  Vector3<double> point(const Vector2<double>& pixel, double z) const {
    const Vector2<double> xy = (pixel - c) / f * (z - height);
    return {xy.x(), xy.y(), z};
  }
};

// Computes everything a second time by angles and pinholes, without homographies, rays or
// derivatives.
TEST(WarpStudy, AgreesWithTracedLight) {
  for (const int number : {1, 2}) {
    const StereoSetup setup{number, {}, 0};
    const int size = 160;
    const WarpStudy study(setup, size);
    const PinholeLens<double> lens = make_lens(setup.camera, size, size);
    const Vector3<double> C = source_centre(setup);
    int compared = 0;
    for (const Vector2<double>& p :
         {Vector2<double>(60, 40), Vector2<double>(101, 77), Vector2<double>(130, 120)}) {
      const auto errors = study.errors(p);
      ASSERT_TRUE(errors);
      const Vector2<double> x =
          traced_image(setup.camera, lens, traced_point(setup.camera, lens, p) - C);
      const TracedVirtualCamera reference(setup.camera, lens, p);
      const TracedVirtualCamera exact(setup.camera, lens, x);
      const TracedVirtualCamera rounded(setup.camera, lens, {std::round(x.x()), std::round(x.y())});
      for (std::size_t k = 0; k < kPatchTexels; ++k) {
        const Vector2<double> q = p + Vector2<double>(2.0 * static_cast<double>(k % 5) - 4,
                                                      2.0 * static_cast<double>(k / 5) - 4);
        const Vector2<double> truth =
            traced_image(setup.camera, lens, traced_point(setup.camera, lens, q) - C);
        const Vector3<double> X = reference.point(q, 4) - C;
        // Bisection ends at 1e-16 of the angle.
        EXPECT_NEAR((*errors)[Warp::kExactCentre][k], (exact.image(X) - truth).norm(), 1e-8);
        EXPECT_NEAR((*errors)[Warp::kRounded][k], (rounded.image(X) - truth).norm(), 1e-8);
        ++compared;
      }
      EXPECT_LT((*errors)[Warp::kFirstOrder][kPatchCentre], 1e-9);
      EXPECT_GT(mean_error((*errors)[Warp::kExactCentre]), 0.01);
    }
    EXPECT_EQ(compared, 75);
  }
}

// Without refraction a virtual camera is the camera itself, for any pixel. (Without tilt: with tilt
// it is aligned with the port, and with f_v = f its scale differs.)
TEST(WarpStudy, HasNoErrorWithoutRefraction) {
  const StereoSetup setup{2, {.n_glass = 1, .n_water = 1}, 30};
  const StudyStatistics result = study_statistics(WarpStudy(setup, 108, 100), 3);
  EXPECT_GT(result.centres, 500);
  for (const Warp warp :
       {Warp::kPapers, Warp::kRounded, Warp::kExactCentre, Warp::kScaledRounded, Warp::kScaled})
    EXPECT_LT(result[warp].largest, 1e-9);
  EXPECT_LT(result[Warp::kPerTexel].largest, 1e-3);
  EXPECT_GT(result[Warp::kFirstOrder].mean, 1e-3);  // a homography is not affine
}

// The local scale in closed form, with mu the index of the water and t the tangent of the angle in
// air: radial f (mu^2 + (mu^2 - 1) t^2)^(3/2) / mu^2, tangential f sqrt(mu^2 + (mu^2 - 1) t^2).
TEST(ScaledVirtualCamera, HasTheLocalScale) {
  const CameraSetup setup;
  const int size = 1001;
  const FlatPortCamera<double> camera(make_lens(setup, size, size), make_port(setup), size, size);
  const double f = camera.lens().fx, mu2 = setup.n_water * setup.n_water;
  for (const double t : {0.0, 0.3, 0.8}) {
    const double q2 = mu2 + (mu2 - 1) * t * t;
    const auto K = scaled_virtual_camera(camera, Vector2<double>(500 + f * t, 500)).pixel_from_ray;
    EXPECT_NEAR(K(0, 0), f * q2 * std::sqrt(q2) / mu2, 1e-6 * f);
    EXPECT_NEAR(K(1, 1), f * std::sqrt(q2), 1e-6 * f);
    EXPECT_NEAR(K(0, 1), 0, 1e-6 * f);
    EXPECT_NEAR(K(1, 0), 0, 1e-6 * f);
  }
}

// With the local scale in both views, the homography's derivative is nearly the true one. The
// remaining error is the motion of C_v.
TEST(ScaledVirtualCamera, LeavesLittleError) {
  for (const int number : {1, 2}) {
    const StudyStatistics result = study_statistics(WarpStudy({number, {}, 0}, 512), 37);
    EXPECT_GT(result.centres, 50);
    EXPECT_LT(result[Warp::kScaled].mean, 0.03 * result[Warp::kExactCentre].mean);
    EXPECT_LT(result[Warp::kScaledRounded].mean_at_centre, 0.003);
  }
}

struct Row {
  const char* series;
  double value;
  int setup;
  double papers;  // [px], mean of the prototype's rounded warp; 0: not known
};

// Requirement: the first-order exact warp has a mean of at most 0.005 px for a field of view of 80
// degrees. The rounded warp agrees with the means of an independent prototype.
TEST(WarpStudy, GivesDesignsTable) {
  for (const Row& row : {Row{"fov_degrees", 80, 1, 0.475}, Row{"distance_mm", 100, 1, 0.462},
                         Row{"tilt_degrees", 6, 1, 0.502}, Row{"plane_degrees", 20, 1, 0},
                         Row{"plane_degrees", 40, 1, 0.487}, Row{"plane_degrees", 60, 1, 0},
                         Row{"fov_degrees", 80, 2, 0.254}, Row{"plane_degrees", 60, 2, 0}}) {
    const Variation variation = vary(row.series, row.value, row.setup);
    const StudyStatistics result = study_statistics(WarpStudy(variation.setup, 2048), 83);
    EXPECT_GT(result.centres, 100);
    EXPECT_LE(result[Warp::kFirstOrder].mean, 0.005) << row.series << row.value;
    EXPECT_LT(result[Warp::kPerTexel].mean, 1e-3);
    if (row.papers > 0) {
      EXPECT_NEAR(result[Warp::kRounded].mean, row.papers, 0.1 * row.papers);
    }
  }
}

TEST(Maps, HoldThePatchesTheySay) {
  const WarpStudy study({1, {}, 0}, 18, 10);
  const auto means = patch_error_map(study, Warp::kPapers);
  const auto exploded = exploded_error_map(study, Warp::kPapers);
  ASSERT_EQ(means.size(), 100u);
  ASSERT_EQ(exploded.size(), 2500u);
  int seen = 0;
  for (std::size_t row = 0; row < 10; ++row) {
    for (std::size_t column = 0; column < 10; ++column) {
      const auto patch = study.errors(
          {static_cast<double>(column) + kPatchReach, static_cast<double>(row) + kPatchReach});
      const double mean = means[row * 10 + column];
      EXPECT_EQ(mean, patch ? mean_error((*patch)[Warp::kPapers]) : -1);
      for (std::size_t k = 0; k < kPatchTexels; ++k)
        EXPECT_EQ(exploded[(row * 5 + k / 5) * 50 + column * 5 + k % 5],
                  patch ? (*patch)[Warp::kPapers][k] : -1);
      seen += patch.has_value();
    }
  }
  EXPECT_GT(seen, 30);
  EXPECT_LT(seen, 100);
}

TEST(StudyStatistics, AreTheMeansOfTheMapForAnyNumberOfThreads) {
  const WarpStudy study({2, {.tilt_degrees = 5}, 20}, 68, 60);
  const auto map = patch_error_map(study, Warp::kPapers);
  double sum = 0;
  std::int64_t count = 0;
  for (const double value : map)
    if (value >= 0) sum += value, ++count;
  const auto with_threads = [&](unsigned threads) {
    const ThreadLimit limit(threads);
    return study_statistics(study, 1);
  };
  const StudyStatistics one = with_threads(1), four = with_threads(4);
  EXPECT_EQ(one.centres, count);
  EXPECT_NEAR(one[Warp::kPapers].mean, sum / static_cast<double>(count), 1e-12);
  for (std::size_t w = 0; w < kWarps; ++w) {
    EXPECT_EQ(one.warps[w].mean, four.warps[w].mean);
    EXPECT_EQ(one.warps[w].mean_at_centre, four.warps[w].mean_at_centre);
  }
  EXPECT_EQ(one.rounding_over_warp, four.rounding_over_warp);
  EXPECT_EQ(one.middle_not_least, four.middle_not_least);
}

}  // namespace
}  // namespace axial::experiments
