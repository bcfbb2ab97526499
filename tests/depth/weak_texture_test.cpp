// SPDX-License-Identifier: GPL-3.0-or-later
#include "depth/weak_texture.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "base/error.h"

namespace axial::depth {
namespace {

DepthMap map_of(const cv::Mat1f& confidence) {
  DepthMap map;
  map.image_path = "photo.jpg";
  map.depth = cv::Mat1f(confidence.size(), 1.0f);
  map.normal = cv::Mat3f(confidence.size(), cv::Vec3f(0, 0, -1));
  map.confidence = confidence;
  return map;
}

cv::Mat1b noise(cv::Size size, double deviation, std::uint64_t seed) {
  cv::RNG random(seed);
  cv::Mat1f values(size, 0.0f);
  random.fill(values, cv::RNG::NORMAL, 128.0, deviation);
  cv::Mat1b image;
  values.convertTo(image, CV_8U);
  return image;
}

int left(const DepthMap& map) {
  return cv::countNonZero(map.depth);
}

TEST(RemoveUnconfirmed, ClearsWeakTextureThatNoPhotographConfirms) {
  const cv::Mat1b weak = noise({40, 30}, 0.7, 1);
  const DepthMap map = map_of(cv::Mat1f(30, 40, 0.55f));
  const DepthMap result = remove_unconfirmed(map, weak);
  EXPECT_EQ(left(result), 0);
  EXPECT_EQ(cv::countNonZero(result.confidence), 0);
  EXPECT_EQ(result.normal(10, 10), cv::Vec3f(0, 0, 0));
  EXPECT_EQ(left(map), 40 * 30) << "the argument changed";
  EXPECT_EQ(left(remove_unconfirmed(map_of(cv::Mat1f(30, 40, 0.65f)), weak)), 40 * 30);
}

TEST(RemoveUnconfirmed, LeavesStrongTextureAsItIs) {
  EXPECT_EQ(left(remove_unconfirmed(map_of(cv::Mat1f(30, 40, 0.1f)), noise({40, 30}, 8, 2))), 1200);
}

TEST(RemoveUnconfirmed, JudgesAPixelByItsSurroundings) {
  const cv::Mat1b weak(30, 40, std::uint8_t{128});
  cv::Mat1f sure(30, 40, 0.8f), unsure(30, 40, 0.3f);
  sure(12, 15) = 0.1f;
  unsure(12, 15) = 0.9f;
  EXPECT_EQ(left(remove_unconfirmed(map_of(sure), weak)), 1200);
  EXPECT_EQ(left(remove_unconfirmed(map_of(unsure), weak)), 0);
}

// Pixels without a depth and pixels with strong texture must not contribute to the mean.
TEST(RemoveUnconfirmed, AgreesWithSumsByHand) {
  constexpr int kWidth = 60, kHeight = 45, kReach = 4;
  cv::Mat1b image = noise({kWidth, kHeight}, 0.8, 3);
  noise({kWidth / 2, kHeight}, 3, 4).copyTo(image(cv::Rect(kWidth / 2, 0, kWidth / 2, kHeight)));
  cv::RNG random(5);
  cv::Mat1f confidence(kHeight, kWidth);
  random.fill(confidence, cv::RNG::UNIFORM, 0.2, 1.0);
  DepthMap map = map_of(confidence);
  for (int i = 0; i < 800; ++i)
    map.depth(random.uniform(0, kHeight), random.uniform(0, kWidth)) = 0;
  const DepthMap result = remove_unconfirmed(map, image);

  const auto is_weak = [&](int x, int y) {
    double sum = 0, squares = 0;
    for (int dy = -kReach; dy <= kReach; ++dy)
      for (int dx = -kReach; dx <= kReach; ++dx) {
        const double grey = image(y + dy, x + dx);
        sum += grey / 81;
        squares += grey * grey / 81;
      }
    return squares - sum * sum < 1.5 * 1.5;
  };
  int cleared = 0, compared = 0;
  for (int y = 2 * kReach; y < kHeight - 2 * kReach; ++y)
    for (int x = 2 * kReach; x < kWidth - 2 * kReach; ++x) {
      if (!(map.depth(y, x) > 0)) continue;
      double sum = 0, count = 0;
      for (int v = y - kReach; v <= y + kReach; ++v)
        for (int u = x - kReach; u <= x + kReach; ++u)
          if (map.depth(v, u) > 0 && is_weak(u, v)) {
            sum += confidence(v, u);
            ++count;
          }
      // Skips means at the threshold, because confidences are rounded to 1/255.
      if (count > 0 && std::abs(sum / count - 0.6) < 0.003) continue;
      const bool expected = is_weak(x, y) && sum < 0.6 * count;
      ASSERT_EQ(result.depth(y, x) == 0, expected) << x << " " << y;
      cleared += expected;
      ++compared;
    }
  EXPECT_GT(cleared, compared / 20);
  EXPECT_LT(cleared, compared / 2);
}

// Borders are judged like weak texture, whatever their texture, by the mean of both.
TEST(RemoveUnconfirmed, JudgesBordersAsWeakTexture) {
  const cv::Mat1b image = noise({40, 30}, 8, 6);
  cv::Mat1b border(30, 40, std::uint8_t{0});
  border(cv::Rect(0, 0, 4, 30)) = 255;
  cv::Mat1f confidence(30, 40, 0.3f);
  DepthMap result = remove_unconfirmed(map_of(confidence), image, border);
  EXPECT_EQ(left(result), 1200 - 4 * 30);
  EXPECT_EQ(cv::countNonZero(result.depth.colRange(0, 4)), 0);
  // Confident depths inside the image do not confirm depths at its border.
  confidence.colRange(4, 40) = 0.95f;
  EXPECT_EQ(left(remove_unconfirmed(map_of(confidence), image, border)), 1200 - 4 * 30);
  confidence.colRange(0, 4) = 0.65f;
  EXPECT_EQ(left(remove_unconfirmed(map_of(confidence), image, border)), 1200);
  // A corner of good depths in a border of bad ones: the windows at rows 0 to 10 hold more of the
  // good ones, by (rows * 0.9 + others * 0.3) / all >= 0.6.
  confidence.colRange(0, 4) = 0.3f;
  confidence(cv::Rect(0, 0, 4, 10)) = 0.9f;
  result = remove_unconfirmed(map_of(confidence), image, border);
  for (int y = 0; y < 30; ++y) {
    int good = 0, all = 0;
    for (int v = std::max(0, y - 4); v <= std::min(29, y + 4); ++v) {
      good += v < 10;
      ++all;
    }
    EXPECT_EQ(result.depth(y, 0) > 0, good * 0.9 + (all - good) * 0.3 >= 0.6 * all) << y;
  }
}

TEST(RemoveUnconfirmed, NeedsTheMapsOwnImage) {
  EXPECT_THROW(remove_unconfirmed(map_of(cv::Mat1f(30, 40, 0.5f)), cv::Mat1b(40, 30)), Error);
}

}  // namespace
}  // namespace axial::depth
