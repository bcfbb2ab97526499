// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/resolution.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace axial {
namespace {

TEST(WorkingSize, HalvesDownToTheMinimumAndCaps) {
  EXPECT_EQ(working_size(2832, 2128, {}), cv::Size(1416, 1064));
  EXPECT_EQ(working_size(2832, 2128, {0, 640, 2560}), cv::Size(2560, 1924));  // 1923.6
  EXPECT_EQ(working_size(640, 479, {1, 640, 2560}), cv::Size(640, 479));      // 320 < 640
  EXPECT_EQ(working_size(1024, 768, {1, 320, 2560}), cv::Size(512, 384));
  EXPECT_EQ(working_size(3072, 2048, {9, 640, 2560}), cv::Size(768, 512));
  EXPECT_EQ(working_size(2128, 2832, {1, 640, 700}), cv::Size(526, 700));
  EXPECT_EQ(working_size(100, 1, {0, 640, 10}), cv::Size(10, 1));
  EXPECT_EQ(working_size(500, 400, {77, 640, 2560}), cv::Size(500, 400));
  EXPECT_THROW(working_size(0, 5, {}), Error);
  EXPECT_THROW(working_size(5, 5, {1, 1, 0}), Error);
}

TEST(SameShape, AllowsForRoundedSides) {
  EXPECT_TRUE(same_shape({2832, 2128}, {1416, 1064}));
  EXPECT_TRUE(same_shape({2560, 1924}, {2832, 2128}));  // 1923.6
  EXPECT_TRUE(same_shape({10, 7}, {1000, 667}));        // 6.67
  EXPECT_FALSE(same_shape({96, 72}, {72, 96}));
  EXPECT_FALSE(same_shape({96, 72}, {72, 72}));
  EXPECT_FALSE(same_shape({1920, 1080}, {1920, 1088}));
  EXPECT_FALSE(same_shape({0, 0}, {96, 72}));
}

TEST(ResizedImage, AveragesAreas) {
  cv::Mat3b image(2, 4, cv::Vec3b(0, 0, 0));
  image(0, 0) = image(1, 1) = {200, 100, 40};
  const cv::Mat3b half = resized_image(image, {2, 1});
  EXPECT_EQ(half(0, 0), cv::Vec3b(100, 50, 20));
  EXPECT_EQ(half(0, 1), cv::Vec3b(0, 0, 0));
  EXPECT_EQ(resized_image(image, image.size()).data, image.data);
  EXPECT_THROW(resized_image({}, {2, 2}), Error);
}

}  // namespace
}  // namespace axial
