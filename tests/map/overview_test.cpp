// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/overview.h"

#include <gtest/gtest.h>

namespace axial::map {
namespace {

TEST(Overview, TheScaleBarHasARoundLength) {
  EXPECT_DOUBLE_EQ(scale_bar_length(16), 5);
  EXPECT_DOUBLE_EQ(scale_bar_length(14), 2);
  EXPECT_DOUBLE_EQ(scale_bar_length(5), 1);
  EXPECT_NEAR(scale_bar_length(0.07), 0.02, 1e-12);
  EXPECT_NEAR(scale_bar_length(3001), 1000, 1e-9);
}

TEST(Overview, TheMapKeepsItsPixels) {
  cv::Mat4b colors(120, 400, cv::Vec4b(10, 20, 30, 255));
  colors(cv::Rect(0, 0, 50, 120)) = cv::Scalar(0, 0, 0, 0);
  const cv::Mat3b picture = draw_overview(colors, {0.01, true});
  EXPECT_EQ(picture.size(), cv::Size(400, 176));
  EXPECT_EQ(picture(60, 20), cv::Vec3b(255, 255, 255));
  EXPECT_EQ(picture(60, 200), cv::Vec3b(30, 20, 10));
}

// A third of 4 m is more than 1 m: the bar is 100 pixels of 1 cm long.
TEST(Overview, TheBarIsAsLongAsItSays) {
  const cv::Mat3b picture =
      draw_overview(cv::Mat4b(120, 400, cv::Vec4b(255, 255, 255, 255)), {0.01, false});
  const int row = 120 + 35;
  int dark = 0;
  for (int x = 0; x < 300; ++x) dark += picture(row, x)[0] < 128;
  EXPECT_EQ(dark, 100);
}

}  // namespace
}  // namespace axial::map
