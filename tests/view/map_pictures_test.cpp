// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/map_pictures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "view/color_scale.h"

namespace axial::view {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

TEST(ColorScale, InterpolatesBetweenItsColours) {
  const ColorScale scale{{{0, 0, 0}, {100, 200, 40}, {200, 200, 40}}, -1, 3};
  EXPECT_EQ(color_of(scale, -1), cv::Vec3b(0, 0, 0));
  EXPECT_EQ(color_of(scale, 0), cv::Vec3b(50, 100, 20));
  EXPECT_EQ(color_of(scale, 1), cv::Vec3b(100, 200, 40));
  EXPECT_EQ(color_of(scale, 2), cv::Vec3b(150, 200, 40));
  EXPECT_EQ(color_of(scale, 3), cv::Vec3b(200, 200, 40));
  EXPECT_EQ(color_of(scale, -9), cv::Vec3b(0, 0, 0));
  EXPECT_EQ(color_of(scale, 99), cv::Vec3b(200, 200, 40));
}

TEST(ColorScale, AScaleWithoutWidthHasOneColour) {
  const ColorScale scale = scale_of(violet_to_yellow(), 2, 2);
  EXPECT_EQ(color_of(scale, 2), violet_to_yellow()[4]);
}

// Red and blue exchange their roles: the sign of a difference shows.
TEST(ColorScale, DifferencesDivergeFromGrey) {
  const ColorScale scale = scale_of(orange_to_blue(), -1, 1);
  const cv::Vec3b gone = color_of(scale, -0.8), none = color_of(scale, 0),
                  came = color_of(scale, 0.8);
  EXPECT_GT(gone[0], gone[2] + 100);
  EXPECT_GT(came[2], came[0] + 100);
  EXPECT_TRUE(none[0] == none[1] && none[1] == none[2]);
  EXPECT_EQ(css_color({1, 32, 255}), "#0120ff");
}

TEST(ColorScale, QuantilesLeaveMissingValuesOut) {
  cv::Mat1f values(1, 201, kNan);
  for (int i = 0; i <= 100; ++i) values(0, 2 * i) = static_cast<float>(100 - i);
  const auto [low, high] = quantiles(values, 0.02, 0.99);
  EXPECT_EQ(low, 2);
  EXPECT_EQ(high, 99);
  const cv::Mat1f nothing(3, 3, kNan);
  EXPECT_EQ(quantiles(nothing, 0, 1), std::pair(0.0, 0.0));
}

TEST(MapPictures, PaintsColoursAndPlacesWithoutValue) {
  const cv::Mat1f values = (cv::Mat1f(1, 3) << 0.0F, kNan, 1.0F);
  const ColorScale scale{{{10, 20, 30}, {200, 100, 50}}, 0, 1};
  const cv::Mat1b shades = (cv::Mat1b(1, 3) << 255, 0, 51);
  const cv::Mat3b picture = painted(values, scale, shades);
  EXPECT_EQ(picture(0, 0), cv::Vec3b(30, 20, 10));  // B G R
  EXPECT_EQ(picture(0, 1), cv::Vec3b(kNothing[2], kNothing[1], kNothing[0]));
  EXPECT_EQ(picture(0, 2), cv::Vec3b(10, 20, 40));

  cv::Mat4b colors(1, 2, cv::Vec4b(1, 2, 3, 255));
  colors(0, 1) = {9, 9, 9, 0};
  EXPECT_EQ(opaque(colors)(0, 0), cv::Vec3b(3, 2, 1));
  EXPECT_EQ(opaque(colors)(0, 1), cv::Vec3b(kNothing[2], kNothing[1], kNothing[0]));
}

// A roof: its side to the left and its side to the top are light.
TEST(MapPictures, ReliefIsLightTowardsTheUpperLeft) {
  cv::Mat1f left(9, 9), top(9, 9);
  for (int y = 0; y < 9; ++y)
    for (int x = 0; x < 9; ++x) {
      left(y, x) = static_cast<float>(-std::abs(x - 4));
      top(y, x) = static_cast<float>(-std::abs(y - 4));
    }
  EXPECT_GT(relief(left, 1, 1)(4, 1), relief(left, 1, 1)(4, 7) + 50);
  EXPECT_GT(relief(top, 1, 1)(1, 4), relief(top, 1, 1)(7, 4) + 50);
  // A plane at 45 degrees with its normal to the light.
  cv::Mat1f plane(9, 9);
  for (int y = 0; y < 9; ++y)
    for (int x = 0; x < 9; ++x) plane(y, x) = static_cast<float>((x + y) * std::sqrt(0.5));
  EXPECT_EQ(relief(plane, 1, 1)(4, 4), 255);
  cv::Mat1f with_hole = cv::Mat1f(3, 3, 5.0F);
  const int level = relief(with_hole, 1, 1)(1, 1);
  with_hole(0, 1) = kNan;
  EXPECT_EQ(relief(with_hole, 1, 1)(1, 1), level);
}

TEST(MapPictures, ReducedValuesAreMeansOfKnownOnes) {
  cv::Mat1f values(40, 60);
  cv::RNG random(3);
  for (float& value : values) value = random.uniform(0, 4) == 0 ? kNan : random.uniform(1.0F, 9.0F);
  values(cv::Rect(0, 0, 10, 10)) = kNan;
  const cv::Mat1f reduced = reduced_values(values, {6, 4});
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 6; ++x) {
      double sum = 0;
      int count = 0;
      for (const float value : cv::Mat1f(values(cv::Rect(10 * x, 10 * y, 10, 10)).clone()))
        if (!std::isnan(value)) sum += static_cast<double>(value), ++count;
      if (count < 50) {
        EXPECT_TRUE(std::isnan(reduced(y, x)));
      } else {
        EXPECT_NEAR(reduced(y, x), sum / count, 1e-4);
      }
    }
  EXPECT_TRUE(std::isnan(reduced(0, 0)));
}

TEST(MapPictures, HeightDataKeepsMillimetres) {
  cv::Mat1f heights(5, 7);
  cv::RNG random(4);
  for (float& value : heights) value = random.uniform(-12.0F, 3.0F);
  heights(2, 3) = kNan;
  const HeightData data = height_data(heights);
  ASSERT_EQ(data.bytes.size(), 70u);
  EXPECT_LT(data.step, 15.0 / 65000);
  for (std::size_t i = 0; i < 35; ++i) {
    const auto byte = [&](std::size_t at) { return static_cast<std::uint8_t>(data.bytes[at]); };
    const int value = byte(2 * i) + 256 * byte(2 * i + 1);
    const float height = heights(static_cast<int>(i) / 7, static_cast<int>(i) % 7);
    if (std::isnan(height)) {
      EXPECT_EQ(value, 0);
    } else {
      EXPECT_NEAR(data.low + (value - 1) * data.step, height, data.step);
    }
  }
  const HeightData level = height_data(cv::Mat1f(1, 1, 2.5F));
  EXPECT_EQ(level.bytes, std::string("\1\0", 2));
  EXPECT_EQ(level.low, 2.5);
}

TEST(MapPictures, NormalsShowTheirDirection) {
  cv::Mat3f normals(4, 4, cv::Vec3f(0, 0, -1));
  normals(cv::Rect(2, 0, 2, 2)) = cv::Vec3f(0.6F, 0, -0.8F);
  normals(cv::Rect(0, 2, 2, 2)) = cv::Vec3f(0, -0.6F, -0.8F);
  normals(cv::Rect(2, 2, 2, 2)) = cv::Vec3f(0, 0, 0);
  const cv::Mat3b picture = normal_picture(normals, {2, 2});
  EXPECT_EQ(picture(0, 0), cv::Vec3b(255, 128, 128));  // to the camera: blue
  EXPECT_EQ(picture(0, 1), cv::Vec3b(230, 128, 204));  // to the right: red
  EXPECT_EQ(picture(1, 0), cv::Vec3b(230, 204, 128));  // upwards: green
  EXPECT_EQ(picture(1, 1), cv::Vec3b(kNothing[2], kNothing[1], kNothing[0]));
}

}  // namespace
}  // namespace axial::view
