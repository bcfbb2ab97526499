// SPDX-License-Identifier: GPL-3.0-or-later
#include "color/transfer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/error_of.h"

namespace axial::color {
namespace {

using testing::HasSubstr;

TEST(Transfer, LightAndValueAreInverse) {
  for (const char* name : {"srgb", "linear", "gamma:2.2"}) {
    const Transfer transfer = Transfer::parse(name);
    for (int i = 0; i <= 100; ++i) {
      const float value = static_cast<float>(i) / 100;
      EXPECT_NEAR(transfer.value(transfer.light(value)), value, 1e-5) << name;
      if (i == 0 || i == 100) continue;
      const float step = 1e-3f;
      const float slope =
          (transfer.light(value + step) - transfer.light(value - step)) / (2 * step);
      EXPECT_NEAR(transfer.slope(value), std::max(1e-3f, slope), 1e-4) << name;
    }
  }
  EXPECT_NEAR(Transfer().light(0.5f), 0.21404f, 1e-5);  // IEC 61966-2-1
}

TEST(Transfer, OtherCurvesAreRefused) {
  for (const char* name : {"log", "gamma:", "gamma:0", "gamma:9", "gamma:x"})
    EXPECT_THAT(axial::test::error_of([&] { Transfer::parse(name); }), HasSubstr("curve is '"));
}

TEST(Transfer, ClippedChannelsAreMarked) {
  const cv::Mat3b bytes(1, 1, cv::Vec3b(0, 128, 255));
  cv::Mat3f light = light_of(bytes, 8, {});
  EXPECT_EQ(light(0, 0)[0], 1);  // R
  mark_unusable(light, {}, {});
  EXPECT_TRUE(std::isnan(light(0, 0)[0]));
  EXPECT_NEAR(light(0, 0)[1], 0.2158, 1e-3);
  EXPECT_EQ(light(0, 0)[2], 0);
  mark_unusable(light, cv::Mat1b(1, 1, std::uint8_t{0}), {});
  EXPECT_TRUE(std::isnan(light(0, 0)[2]));
}

TEST(Transfer, ValuesOfFewerBitsReachWhite) {
  const cv::Mat3w words(1, 1, cv::Vec3w(0, 2048, 4095));
  const cv::Mat3f light = light_of(words, 12, Transfer::parse("linear"));
  EXPECT_NEAR(light(0, 0)[1], 2048 / 4095.0, 1e-6);
  EXPECT_EQ(light(0, 0)[0], 1);
}

}  // namespace
}  // namespace axial::color
