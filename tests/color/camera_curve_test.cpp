// SPDX-License-Identifier: GPL-3.0-or-later
#include "color/camera_curve.h"

#include <gtest/gtest.h>

#include <cmath>

#include "synthetic.h"

namespace axial::color {
namespace {

constexpr std::uint32_t kPhotographs = 24;

// Exposures within `stops` powers of two, in no order.
std::vector<double> exposures_within(double stops) {
  std::vector<double> exposures;
  for (std::uint32_t view = 0; view < kPhotographs; ++view)
    exposures.push_back(
        std::exp2(stops * (static_cast<double>(view * 7 % kPhotographs) / 11.5 - 1)));
  return exposures;
}

// The light by `from` of photographs that a camera with the curve `camera` took.
Observations taken(const Transfer& camera, const Transfer& from,
                   std::span<const double> exposures) {
  Observations observations =
      test::synthetic(3000, 0.7f, 2.5f, 0.01, 5, test::in_plain_water, kPhotographs).observations;
  for (Observation& seen : observations.all)
    for (int k = 0; k < 3; ++k)
      seen.light[k] =
          from.light(camera.value(0.4f * seen.light[k] * static_cast<float>(exposures[seen.view])));
  return observations;
}

TEST(ExposuresOf, HaveTheMeanOne) {
  const Exposures exposures = exposures_of(std::vector<double>{2, 8});
  EXPECT_NEAR(exposures[0][1], 0.5, 1e-6);
  EXPECT_NEAR(exposures[1][2], 2, 1e-6);
}

// Curves are found again, also if they are far from that of sRGB.
TEST(FindCurve, FindsTheCurveOfTheCamera) {
  const std::vector<double> exposures = exposures_within(1);
  for (const double gamma : {1.0, 1.57, 2.8}) {
    const CameraCurve found = find_curve(
        exposures_of(exposures), taken(Transfer::of_gamma(gamma), {}, exposures), {}, Light::sun);
    EXPECT_TRUE(found.is_told) << gamma;
    // Powers are tried in steps of up to 2 %, and the light has a noise of 1 %.
    EXPECT_NEAR(found.transfer.gamma().value_or(0), gamma, 0.02 * gamma);
    // A power that is wrong by a fifth turns exposures of one stop into differences of 15 % and
    // more.
    EXPECT_LT(found.spread, 0.5 * found.spread_first);
  }
}

TEST(FindCurve, KeepsACurveThatAgrees) {
  const std::vector<double> exposures = exposures_within(1);
  for (const Transfer& curve : {Transfer(), Transfer::of_gamma(1.4)}) {
    const CameraCurve found =
        find_curve(exposures_of(exposures), taken(curve, curve, exposures), curve, Light::sun);
    EXPECT_TRUE(found.is_told);
    EXPECT_EQ(found.transfer.name(), curve.name());
    EXPECT_EQ(found.spread, found.spread_first);
  }
}

TEST(FindCurve, NeedsExposuresThatDiffer) {
  const std::vector<double> exposures(kPhotographs, 1);
  const CameraCurve found = find_curve(
      exposures_of(exposures), taken(Transfer::of_gamma(1.8), {}, exposures), {}, Light::sun);
  EXPECT_FALSE(found.is_told);
  EXPECT_EQ(found.transfer.name(), "srgb");
}

// With the inverse of the exposures, points agree less than without any.
TEST(SpreadWith, IsLeastWithTheExposures) {
  const std::vector<double> exposures = exposures_within(1);
  std::vector<double> inverse;
  for (const double exposure : exposures) inverse.push_back(1 / exposure);
  const Observations observations = taken({}, {}, exposures);
  const auto spread = [&](const std::vector<double>& of) {
    return spread_with(exposures_of(of), observations, {}, Light::sun);
  };
  const double right = spread(exposures);
  const double none = spread(std::vector<double>(kPhotographs, 1));
  EXPECT_LT(right, 0.5 * none);
  EXPECT_LT(none, spread(inverse));
}

}  // namespace
}  // namespace axial::color
