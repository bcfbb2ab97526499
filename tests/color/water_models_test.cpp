// SPDX-License-Identifier: GPL-3.0-or-later
// Fits of light whose formula is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "color/exposure.h"
#include "color/restore.h"
#include "color/synthetic.h"

namespace axial::color {
namespace {

using test::in_light_of_lamps;
using test::in_plain_water;
using test::synthetic;
using test::Synthetic;

// The largest of the channels' median errors of J, as shares, after the best scale of each channel.
double error_of_surfaces(const Synthetic& data, const WaterModel& model) {
  double worst = 0;
  for (int k = 0; k < 3; ++k) {
    std::vector<float> ratios;
    for (const Observation& seen : data.observations.all)
      ratios.push_back(surface_light(model, seen.sight, seen.light)[k] /
                       data.surfaces[seen.point][k]);
    std::ranges::sort(ratios);
    const float scale = ratios[ratios.size() / 2];
    std::vector<double> errors;
    for (const float ratio : ratios) errors.push_back(std::abs(ratio / scale - 1));
    std::ranges::sort(errors);
    worst = std::max(worst, errors[errors.size() / 2]);
  }
  return worst;
}

TEST(SunWater, ExactLightGivesExactCoefficients) {
  const Synthetic data = synthetic(500, 1, 4, 0, 1, in_plain_water);
  const SunWater water = fit_sun(data.observations, {});
  const std::array<double, 3> a{0.6, 0.3, 0.2}, b{0.5, 0.25, 0.2}, veil{0.05, 0.2, 0.25};
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(water.channels[k].a.value, a[k], 1e-3);
    EXPECT_NEAR(water.channels[k].b.value, b[k], 1e-2);
    EXPECT_NEAR(water.channels[k].veil.value, veil[k], 1e-2);
    EXPECT_TRUE(water.channels[k].determined);
  }
  EXPECT_LT(error_of_surfaces(data, water), 1e-3);
}

// The veil is twice as bright at one end of the directions as at the other.
TEST(SunWater, FindsAVeilThatDependsOnTheDirection) {
  const auto brighter = [](const Sight& sight) { return std::exp(0.58f * sight.direction.x()); };
  const Synthetic data =
      synthetic(2000, 1, 4, 0.01, 11, [&](const Sight& sight, const Eigen::Array3f& surface) {
        const Eigen::Array3f direct =
            in_plain_water(sight, surface) - in_plain_water(sight, Eigen::Array3f::Zero());
        return Eigen::Array3f(direct +
                              brighter(sight) * in_plain_water(sight, Eigen::Array3f::Zero()));
      });
  const SunWater water = fit_sun(data.observations, {});
  EXPECT_NEAR(water.channels[1].a.value, 0.3, 0.01);
  EXPECT_NEAR(water.channels[1].veil_by_direction.x(), 0.58, 0.07);
  EXPECT_NEAR(water.channels[1].veil_by_direction.y(), 0, 0.07);
  EXPECT_LT(error_of_surfaces(data, water), 0.02);
}

TEST(SunWater, ErrorsAreWithinThreeStandardDeviations) {
  const std::array<double, 3> a{0.6, 0.3, 0.2};
  int within = 0, all = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Synthetic data = synthetic(2000, 1, 4, 0.03, seed, in_plain_water);
    const SunWater water = fit_sun(data.observations, {});
    for (std::size_t k = 0; k < 3; ++k) {
      const Estimate& found = water.channels[k].a;
      EXPECT_LT(found.sigma, 0.05);
      within += std::abs(found.value - a[k]) <= 3 * found.sigma;
      ++all;
    }
  }
  EXPECT_GE(within, 57) << "of " << all;  // 95 %
}

TEST(SunWater, OutliersHardlyMatter) {
  Synthetic data = synthetic(2000, 1, 4, 0.02, 3, in_plain_water);
  for (std::size_t i = 0; i < data.observations.all.size(); i += 10)
    data.observations.all[i].light *= 3;
  const SunWater water = fit_sun(data.observations, {});
  EXPECT_NEAR(water.channels[0].a.value, 0.6, 0.03);
  EXPECT_NEAR(water.channels[1].a.value, 0.3, 0.03);
}

TEST(SunWater, EqualDistancesDetermineNothing) {
  const Synthetic data = synthetic(2000, 2, 2.01f, 0.03, 4, in_plain_water);
  const WaterModel water = fit_sun(data.observations, {});
  for (const bool known : determined(water)) EXPECT_FALSE(known);
  // Then the light stays as it is.
  const Observation& seen = data.observations.all.front();
  EXPECT_TRUE((surface_light(water, seen.sight, seen.light) == seen.light).all());
}

// Multiplies the light of each photograph and channel by a factor within one stop.
Exposures expose(Observations& observations, std::size_t views) {
  std::mt19937 random(15);
  Exposures exposures(views, Eigen::Array3f::Ones());
  for (Eigen::Array3f& exposure : exposures)
    for (float& factor : exposure)
      factor = std::exp2(static_cast<float>(random() % 1000) / 500 - 1);
  for (Observation& one : observations.all) one.light *= exposures[one.view];
  return exposures;
}

// The mean of all exposures cannot be told from the light of the surfaces.
template <class Fit>
double error_of_exposures(Synthetic data, const Fit& fit) {
  constexpr std::size_t kViews = 24;
  Observations& seen = data.observations;
  const Exposures truth = expose(seen, kViews);
  Exposures found = even_exposures(seen, kViews), step = found;
  for (int i = 0; i < 4; ++i) {
    seen = divided_by(step, std::move(seen));
    step = exposures_by(fit(seen), seen, kViews);
    for (std::size_t view = 0; view < kViews; ++view) found[view] *= step[view];
  }
  EXPECT_LT(difference_of(step), 0.005);
  for (std::size_t view = 0; view < kViews; ++view) found[view] /= truth[view];
  return difference_of(found);
}

TEST(Exposures, AreFoundWithTheModel) {
  const auto sun = [](const Observations& seen) -> WaterModel { return fit_sun(seen, {}); };
  const auto lamps = [](const Observations& seen) -> WaterModel { return fit_lamps(seen, {}); };
  EXPECT_LT(error_of_exposures(synthetic(1200, 1, 4, 0.01, 14, in_plain_water), sun), 0.02);
  EXPECT_LT(error_of_exposures(synthetic(3000, 0.8f, 2, 0.01, 14, in_light_of_lamps), lamps), 0.02);
}

TEST(LampField, SurfacesComeBackWithoutKnowingTheLamps) {
  const Synthetic data = synthetic(4000, 0.8f, 2, 0.01, 5, in_light_of_lamps);
  const WaterModel lamps = fit_lamps(data.observations, {});
  // The light differs by a factor of 30 between the photographs of a point; a grid of 7 x 5 x 4
  // nodes follows it within 2 %, and the noise is 1 %.
  EXPECT_LT(error_of_surfaces(data, lamps), 0.025);
}

// A shadow halves the light of a third of the observations: they are marked, and do not matter.
TEST(LampField, TakesOnlyObservationsWithoutShadows) {
  Synthetic data = synthetic(4000, 0.8f, 2, 0.01, 5, in_light_of_lamps);
  Synthetic shadowed = data;
  for (std::size_t i = 0; i < data.observations.all.size(); i += 3) {
    shadowed.observations.all[i].light *= 0.5f;
    shadowed.observations.all[i].open = false;
  }
  EXPECT_LT(error_of_surfaces(data, fit_lamps(shadowed.observations, {})), 0.03);
}

TEST(LampField, IsTheSameForAnyNumberOfThreads) {
  const Synthetic data = synthetic(800, 0.8f, 2, 0.01, 6, in_light_of_lamps);
  const LampField all = fit_lamps(data.observations, {});
  const ThreadLimit one(1);
  const LampField alone = fit_lamps(data.observations, {});
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(all.channels[k].veil, alone.channels[k].veil);
    EXPECT_EQ(all.channels[k].light, alone.channels[k].light);
  }
}

TEST(LampField, ChannelsWithoutLightAreNotDetermined) {
  Synthetic data = synthetic(2000, 0.8f, 2, 0.01, 7, in_light_of_lamps);
  std::mt19937 random(8);
  for (Observation& seen : data.observations.all)
    seen.light[0] = 0.02f + 0.002f * static_cast<float>(random() % 100) / 100;
  const WaterModel lamps = fit_lamps(data.observations, {});
  EXPECT_FALSE(determined(lamps)[0]);
  EXPECT_TRUE(determined(lamps)[1]);
  EXPECT_TRUE(determined(lamps)[2]);
}

TEST(ChooseLight, TellsTheSunFromLamps) {
  EXPECT_EQ(choose_light(synthetic(3000, 1, 4, 0.03, 9, in_plain_water).observations, {}).light,
            Light::sun);
  EXPECT_EQ(
      choose_light(synthetic(3000, 0.8f, 2, 0.03, 10, in_light_of_lamps).observations, {}).light,
      Light::lamp);
}

}  // namespace
}  // namespace axial::color
