// SPDX-License-Identifier: GPL-3.0-or-later
#include "color/daylight.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "color/brightness.h"
#include "color/synthetic.h"

namespace axial::color {
namespace {

using test::in_plain_water;
using test::synthetic;
using test::Synthetic;

SunWater water_with(const std::array<double, 3>& losses) {
  SunWater water;
  for (std::size_t k = 0; k < 3; ++k) {
    water.channels[k].a = {losses[k], 0.01};
    water.channels[k].b = water.channels[k].a;
    water.channels[k].determined = true;
  }
  return water;
}

TEST(Daylight, NamesOfTypesAreReadBack) {
  for (const char* name : {"jerlov-I", "jerlov-IB", "jerlov-1C", "jerlov-9C"})
    EXPECT_EQ(name_of(parse_water_type(name)), name);
  EXPECT_EQ(name_of(2.4), "jerlov-IB");
  EXPECT_THROW(parse_water_type("jerlov-2C"), Error);
  EXPECT_THROW(parse_water_type("IB"), Error);
}

// The losses by depth of type 3C are between those of the table at 600, 535 and 462 nm within the
// width of the channels: 0.33, 0.20 and 0.35 /m.
TEST(Daylight, OfAKnownTypeIsThatOfTheTable) {
  const auto daylight = daylight_of(SunWater(), parse_water_type("jerlov-3C"));
  ASSERT_TRUE(daylight);
  EXPECT_NEAR(daylight->losses[0].value, 0.33, 0.04);
  EXPECT_NEAR(daylight->losses[1].value, 0.20, 0.02);
  EXPECT_NEAR(daylight->losses[2].value, 0.35, 0.04);
  EXPECT_LT(daylight->losses[0].sigma, 1e-6);  // only the scattering is unknown
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_GT(daylight->beams[k].value, daylight->losses[k].value);
}

// Each type is found from its own losses along a ray, and its losses by depth within three stated
// standard deviations.
TEST(Daylight, TheTypeIsFoundByTheLossesAlongRays) {
  for (const char* name : {"jerlov-I", "jerlov-IB", "jerlov-II", "jerlov-1C", "jerlov-5C"}) {
    const WaterType type = parse_water_type(name);
    const auto truth = daylight_of(SunWater(), type);
    const auto found = daylight_of(
        water_with({truth->beams[0].value, truth->beams[1].value, truth->beams[2].value}), {});
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->type, type, 1.5) << name;
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(found->losses[k].value, truth->losses[k].value, 3 * found->losses[k].sigma);
      EXPECT_LT(found->losses[k].sigma, 0.3 * truth->losses[k].value + 0.1);
    }
  }
}

TEST(Daylight, NothingIsKnownWithoutAChannel) {
  EXPECT_FALSE(daylight_of(SunWater(), {}));
}

TEST(Daylight, AssumedWaterFillsChannelsThatAreNotDetermined) {
  SunWater water = water_with({0.5, 0.3, 0.2});
  water.channels[0] = {};
  const auto daylight = daylight_of(water, parse_water_type("jerlov-IB"));
  assume(*daylight, water);
  EXPECT_TRUE(water.channels[0].determined);
  EXPECT_TRUE(water.channels[0].assumed);
  EXPECT_EQ(water.channels[0].a.value, daylight->beams[0].value);
  EXPECT_EQ(water.channels[1].a.value, 0.3);
  EXPECT_FALSE(water.channels[1].assumed);
}

// Points of equal albedo at different heights become equally bright.
TEST(Daylight, HigherSurfacesBecomeAsBrightAsLowerOnes) {
  Synthetic data = synthetic(1000, 1, 4, 0, 12, in_plain_water);
  const double loss = 0.25;
  for (Observation& seen : data.observations.all)
    seen.sight.height = 0.001f * static_cast<float>(seen.point);
  SunWater water = water_with({0.6, 0.3, 0.2});
  Daylight daylight;
  for (Estimate& one : daylight.losses) one = {loss, 0.01};
  remove_daylight_loss(daylight, data.observations, water);
  EXPECT_NEAR(water.level, 0.5, 0.002);
  Sight low, high;
  low.way = high.way = 2;
  high.height = 1;
  EXPECT_NEAR(water.factor(high)[1] / water.factor(low)[1], std::exp(loss), 1e-5);
}

TEST(BrightnessByWay, IsEvenWithTheRightModelAndFallsBefore) {
  const Synthetic data = synthetic(2000, 1, 4, 0.02, 13, in_plain_water);
  const auto layers = brightness_by_way(data.observations, fit_sun(data.observations, {}));
  ASSERT_EQ(layers.size(), 12U);
  for (const BrightnessAt& layer : layers)
    EXPECT_TRUE((layer.after - 1).abs().maxCoeff() < 0.02f) << layer.after;
  EXPECT_LT(layers.front().way, 1.3);
  EXPECT_GT(layers.back().way, 3.7);
  EXPECT_LT(layers.back().before[0], 0.5f * layers.front().before[0]);
  EXPECT_TRUE(brightness_by_way({}, SunWater()).empty());
}

}  // namespace
}  // namespace axial::color
