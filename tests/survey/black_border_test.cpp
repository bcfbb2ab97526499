// SPDX-License-Identifier: GPL-3.0-or-later
#include "survey/black_border.h"

#include <gtest/gtest.h>

namespace axial::survey {
namespace {

TEST(BlackBorder, OnlyBlackAtTheEdgeIsLeftOut) {
  cv::Mat3b image(60, 80, cv::Vec3b(90, 100, 110));
  image(cv::Rect(0, 0, 80, 7)).setTo(cv::Scalar(1, 0, 3));     // compression changes black a little
  image(cv::Rect(30, 30, 20, 10)).setTo(cv::Scalar(0, 0, 0));  // a black thing
  const cv::Mat1b usable = outside_black_border(image);
  ASSERT_EQ(usable.size(), image.size());
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 80; ++x) EXPECT_EQ(usable(y, x), y < 10 ? 0 : 255) << x << " " << y;
}

TEST(BlackBorder, AnImageWithoutBorderIsUsedAsAWhole) {
  const cv::Mat3b image(60, 80, cv::Vec3b(9, 10, 11));
  EXPECT_TRUE(outside_black_border(image).empty());
}

}  // namespace
}  // namespace axial::survey
