// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/height_error.h"

#include <gtest/gtest.h>

#include <cmath>

#include "map/geotiff.h"
#include "texture/painted_room.h"

namespace axial::map {
namespace {

constexpr double kBase = 0.4, kHeight = 2, kNoise = 0.3;

// A camera that looks down from (x, 0, kHeight).
simulate::View view_from(double x) {
  simulate::View view;
  view.rotation = Eigen::Vector3d(1, -1, -1).asDiagonal();
  view.centre = {x, 0, kHeight};
  return view;
}

struct Pair {
  simulate::Lens lens = simulate::make_lens(1000, 1000, 60);
  simulate::Port port;
  std::vector<PosedCamera> photos;

  explicit Pair(double distance_of_port) {
    port.distance = distance_of_port, port.thickness = distance_of_port / 4;
    port.n_glass = 1.5, port.n_water = 1.333;
    CameraModel camera = test::camera_of(lens, port);
    if (distance_of_port == 0) camera.port.reset();
    for (const double x : {-kBase, kBase}) {
      const simulate::View view = view_from(x);
      photos.push_back({camera, {view.rotation, view.centre}});
    }
  }

  double resolution(double pixel) const { return HeightErrors::kResolution * pixel; }
};

// From (X, Y, Z) in the camera follow u = f X / Z and v = f Y / Z. At the origin of the world, both
// cameras have Y = 0, and the disparity is 2 f kBase / Z.
struct Analytic {
  double up, across, pixel;

  explicit Analytic(double focal) {
    up = kHeight * kHeight * kNoise * std::sqrt(2) / (2 * kBase * focal);
    across = kHeight / focal * kNoise / std::sqrt(2);
    pixel = kHeight / focal / std::sqrt(1 + kBase * kBase / (kHeight * kHeight) / 2);
  }
};

TEST(HeightErrors, AreThoseOfTheDisparityInAir) {
  const Pair pair(0);
  const HeightErrors errors(pair.photos, {0, 0, 1}, kNoise);
  const Analytic truth(pair.lens.focal);
  const double expected = std::hypot(truth.up, pair.resolution(truth.pixel));
  EXPECT_NEAR(errors.at({0, 0, 0}, {0, 0, 3}, std::vector{0u, 1u}), expected, 1e-4 * expected);
}

// On a slope across the base, errors across count, too, and the slope makes them errors of heights.
TEST(HeightErrors, GrowOnSlopes) {
  const Pair pair(0);
  const HeightErrors errors(pair.photos, {0, 0, 1}, kNoise);
  const Analytic truth(pair.lens.focal);
  const auto at = [&](double angle) {
    return errors.at({0, 0, 0}, {0, std::sin(angle), std::cos(angle)}, std::vector{0u, 1u});
  };
  const double angle = 1.1;
  const double along =
      std::hypot(std::hypot(std::cos(angle) * truth.up, std::sin(angle) * truth.across),
                 pair.resolution(truth.pixel));
  EXPECT_NEAR(at(angle), along / std::cos(angle), 1e-4 * along / std::cos(angle));
  EXPECT_GT(at(angle), 1.2 * at(0));
  EXPECT_LT(at(std::numbers::pi / 2), 0.1);  // a limit for upright faces
}

// The simulator traces the light of both cameras through the port. By symmetry the two paths of the
// pixels u and -u meet above the origin.
TEST(HeightErrors, AreThoseOfThePathsOfLightBehindAPort) {
  const Pair pair(0.05);
  const double middle = pair.lens.cy;
  const auto height = [&](double u) {
    const auto ray = simulate::trace_pixel(pair.lens, &pair.port, u, middle);
    const simulate::SceneRay path = simulate::to_world(view_from(-kBase), *ray);
    return path.start.z() - path.start.x() / path.direction.x() * path.direction.z();
  };
  double low = pair.lens.cx + 10, high = 999;  // pixels whose paths meet below and above 0
  for (int k = 0; k < 60; ++k) (height((low + high) / 2) < 0 ? low : high) = (low + high) / 2;
  const double up = (height(low + 0.01) - height(low - 0.01)) / 0.02 * kNoise / std::sqrt(2);
  const HeightErrors errors(pair.photos, {0, 0, 1}, kNoise);
  const double found = errors.at({0, 0, 0}, {0, 0, 1}, std::vector{0u, 1u});
  const double pixel = std::sqrt(found * found - up * up) / HeightErrors::kResolution;
  EXPECT_NEAR(pixel, kHeight / 1.333 / pair.lens.focal, 0.1 * kHeight / pair.lens.focal);
  const Analytic in_air(pair.lens.focal);
  EXPECT_LT(found, 0.9 * std::hypot(in_air.up, pair.resolution(in_air.pixel)));
}

TEST(HeightErrors, ScaleWithTheNoiseAndFallWithMorePhotographs) {
  Pair pair(0.05);
  pair.photos.push_back(pair.photos[0]);
  pair.photos.back().pose.centre = {0, kBase, kHeight};
  const auto at = [&](double noise, const std::vector<std::uint32_t>& views) {
    const double error =
        HeightErrors(pair.photos, {0, 0, 1}, noise).at({0.1, 0.1, 0.1}, {0, 0, 1}, views);
    const double none =
        HeightErrors(pair.photos, {0, 0, 1}, 1e-6).at({0.1, 0.1, 0.1}, {0, 0, 1}, views);
    return std::sqrt(error * error - none * none);
  };
  EXPECT_NEAR(at(2, {0, 1}) / at(1, {0, 1}), 2, 1e-3);
  EXPECT_LT(at(1, {0, 1, 2}), 0.99 * at(1, {0, 1}));
}

TEST(HeightErrors, NeedTwoPhotographs) {
  const Pair pair(0.05);
  const HeightErrors errors(pair.photos, {0, 0, 1}, kNoise);
  EXPECT_EQ(errors.at({0, 0, 0}, {0, 0, 1}, std::vector{1u}), kNoHeight);
  EXPECT_EQ(errors.at({0, 0, 0}, {0, 0, 1}, {}), kNoHeight);
  EXPECT_EQ(errors.at({0, 0, 0}, {0, 0, 0}, std::vector{0u, 1u}), kNoHeight);
  // Twice the same place: the distance is open, but at most as uncertain as it is large.
  const float same = errors.at({0, 0, 0}, {0, 0, 1}, std::vector{0u, 0u});
  EXPECT_GT(same, 1);
  EXPECT_LT(same, 3);
}

}  // namespace
}  // namespace axial::map
