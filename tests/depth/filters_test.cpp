// SPDX-License-Identifier: GPL-3.0-or-later
#include "depth/filters.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "base/error.h"
#include "base/hash.h"
#include "base/parallel.h"
#include "support/analytic_scene.h"

namespace axial::depth {
namespace {

using test::AnalyticScene;

DepthMap flat_map(int width, int height, float depth) {
  DepthMap map;
  map.camera = test::dry_camera();
  map.camera.width = width;
  map.camera.height = height;
  map.depth = cv::Mat1f(height, width, depth);
  map.normal = cv::Mat3f(height, width, cv::Vec3f(0, 0, -1));
  map.confidence = cv::Mat1f(height, width, 0.5f);
  return map;
}

bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() &&
         std::memcmp(a.data, b.data, a.total() * a.elemSize()) == 0;
}

TEST(RemoveSpeckles, ClearsSmallSegmentsOfOtherDepth) {
  DepthMap map = flat_map(60, 50, 1);
  map.depth(cv::Rect(5, 5, 9, 11)).setTo(1.5);       // 99 pixels
  map.depth(cv::Rect(30, 5, 10, 10)).setTo(1.5);     // 100 pixels
  map.depth(cv::Rect(30, 30, 10, 10)).setTo(1.006);  // a step too small to separate it
  const cv::Mat1f before = map.depth.clone();
  const DepthMap result = remove_speckles(map);
  EXPECT_EQ(result.depth(10, 8), 0);
  EXPECT_EQ(result.normal(10, 8), cv::Vec3f(0, 0, 0));
  EXPECT_EQ(result.confidence(10, 8), 0);
  EXPECT_EQ(cv::countNonZero(result.depth), 60 * 50 - 99);
  EXPECT_TRUE(same(map.depth, before)) << "the argument changed";
}

TEST(RemoveSpeckles, WorksWithoutNormalsAndConfidence) {
  DepthMap map = flat_map(20, 5, 0);
  map.normal.release();
  map.confidence.release();
  map.depth(2, 2) = 1;
  EXPECT_EQ(cv::countNonZero(remove_speckles(map).depth), 0);
  EXPECT_EQ(cv::countNonZero(remove_speckles(map, {0.007f, 1}).depth), 1);
}

TEST(FillGaps, ContinuesAPlane) {
  for (const bool port : {false, true}) {
    const CameraModel model = port ? test::behind_port(test::dry_camera()) : test::dry_camera();
    const DepthMap exact = test::exact_map({}, model, Pose{});
    DepthMap map = exact;
    map.depth = exact.depth.clone();
    map.confidence = exact.confidence.clone();
    map.depth(cv::Rect(40, 0, 7, map.height())).setTo(0);
    map.confidence(cv::Rect(0, 0, 40, map.height())).setTo(0.25);
    const DepthMap result = fill_gaps(map);
    for (int y = 0; y < map.height(); ++y) {
      for (int x = 40; x < 47; ++x) {
        // On a plane, 1 / lambda is linear in the pixel except for the obliquity of the rays. Over
        // the gap, with a focal length of 75 px, the error is up to (8 / 75)^2 / 8.
        ASSERT_NEAR(result.depth(y, x), exact.depth(y, x), 1.5e-3) << x << " " << y;
        ASSERT_NEAR(cv::norm(result.normal(y, x), exact.normal(y, x)), 0, 1e-6);
        ASSERT_EQ(result.confidence(y, x), 0.25f);
      }
    }
  }
}

TEST(FillGaps, LeavesWideGapsStepsAndMaskedPixels) {
  DepthMap map = flat_map(40, 1, 1);
  map.depth(cv::Rect(3, 0, 8, 1)).setTo(0);  // 8 px wide
  map.depth(cv::Rect(20, 0, 3, 1)).setTo(0);
  map.depth(cv::Rect(23, 0, 17, 1)).setTo(1.05);  // a step across the gap
  map.depth(0, 30) = 0;
  map.depth(0, 35) = 0;
  cv::Mat1b mask(1, 40, static_cast<unsigned char>(0));
  mask(0, 35) = 1;
  const DepthMap result = fill_gaps(map, {}, mask);
  EXPECT_EQ(cv::countNonZero(result.depth), 40 - 8 - 3 - 1);
  EXPECT_FLOAT_EQ(result.depth(0, 30), 1.05f);
  EXPECT_EQ(result.depth(0, 35), 0);
}

TEST(FillGaps, FillsColumnsAfterRows) {
  DepthMap map = flat_map(20, 20, 2);
  map.depth(cv::Rect(0, 10, 20, 2)).setTo(0);
  EXPECT_EQ(cv::countNonZero(fill_gaps(map).depth), 400);
}

class AdjustWithCamera : public testing::TestWithParam<bool> {
 protected:
  static CameraModel model() {
    return GetParam() ? test::behind_port(test::dry_camera()) : test::dry_camera();
  }
  static std::vector<DepthMap> exact_maps(const AnalyticScene& world, std::size_t count = 5) {
    std::vector<DepthMap> maps;
    for (const Pose& pose : test::circle_of_poses(count)) {
      maps.push_back(exact_map(world, model(), pose));
    }
    return maps;
  }
  static DepthMap adjust_first(const std::vector<DepthMap>& maps) {
    return adjust_with_neighbours(maps[0], std::span(maps).subspan(1));
  }
};
INSTANTIATE_TEST_SUITE_P(Cameras, AdjustWithCamera, testing::Values(false, true),
                         [](const auto& parameter) { return parameter.param ? "Port" : "Dry"; });

TEST_P(AdjustWithCamera, LeavesExactDepthsOfAPlane) {
  const std::vector<DepthMap> maps = exact_maps({});
  const cv::Mat1f before = maps[0].depth.clone();
  const DepthMap result = adjust_first(maps);
  EXPECT_TRUE(same(maps[0].depth, before)) << "the argument changed";
  EXPECT_GT(cv::countNonZero(result.depth), 96 * 72 * 8 / 10);  // not all pixels at the border
  for (int y = 0; y < result.height(); ++y) {
    for (int x = 0; x < result.width(); ++x) {
      if (result.depth(y, x) == 0) continue;
      // Splats follow their tangent planes, so only rounding errors remain.
      ASSERT_NEAR(result.depth(y, x), maps[0].depth(y, x), 2e-6) << x << " " << y;
      ASSERT_GT(result.confidence(y, x), 0.9f);
    }
  }
}

// Adds nearly Gaussian noise of the relative standard deviation `sigma` to every map.
void add_noise(std::vector<DepthMap>& maps, float sigma) {
  std::uint64_t counter = 0;
  for (DepthMap& map : maps) {
    for (float& depth : map.depth) {
      float sum = -6;
      for (int k = 0; k < 12; ++k) sum += unit_float(scramble(counter++));
      depth *= 1 + sigma * sum;
    }
  }
}

TEST_P(AdjustWithCamera, AveragesNoise) {
  const std::vector<DepthMap> exact = exact_maps({});
  std::vector<DepthMap> maps = exact_maps({});
  constexpr float kSigma = 0.002f;
  add_noise(maps, kSigma);
  const DepthMap result = adjust_first(maps);
  double squares = 0, bias = 0;
  int count = 0;
  for (int y = 8; y < result.height() - 8; ++y) {
    for (int x = 8; x < result.width() - 8; ++x) {
      if (result.depth(y, x) == 0) continue;
      const double error = static_cast<double>(result.depth(y, x) / exact[0].depth(y, x) - 1);
      squares += error * error;
      bias += error;
      ++count;
    }
  }
  ASSERT_GT(count, 3000);
  // The mean of five independent maps has sigma / sqrt(5) = 0.45 sigma if splats add no error.
  EXPECT_LT(std::sqrt(squares / count), 0.5 * static_cast<double>(kSigma));
  // A z-buffer that always kept the nearest sample would shift the mean by about half a sigma.
  EXPECT_LT(std::abs(bias / count), 0.05 * static_cast<double>(kSigma));
}

TEST_P(AdjustWithCamera, RemovesWhatTheNeighboursDeny) {
  for (const float factor : {0.8f, 1.25f}) {  // before and behind the neighbours' surface
    std::vector<DepthMap> maps = exact_maps({});
    const cv::Rect wrong(30, 20, 30, 25);
    maps[0].depth(wrong) *= factor;
    const DepthMap result = adjust_first(maps);
    EXPECT_EQ(cv::countNonZero(result.depth(wrong)), 0) << factor;
    EXPECT_EQ(result.confidence(30, 40), 0);
    EXPECT_EQ(result.normal(30, 40), cv::Vec3f(0, 0, 0));
    EXPECT_NE(result.depth(60, 40), 0);
  }
}

TEST_P(AdjustWithCamera, KeepsASphereInFrontOfThePlane) {
  AnalyticScene world;
  world.sphere_centre = {0, 0, 0.75};
  world.sphere_radius = 0.12;
  const std::vector<DepthMap> maps = exact_maps(world);
  const DepthMap result = adjust_first(maps);
  int kept = 0, far_off = 0;
  for (int y = 0; y < result.height(); ++y) {
    for (int x = 0; x < result.width(); ++x) {
      if (result.depth(y, x) == 0) continue;
      ++kept;
      // At the distance of a pixel (13 mm), a tangent plane is 13^2 / (2 * 120) = 0.7 mm off the
      // sphere.
      if (std::abs(result.depth(y, x) - maps[0].depth(y, x)) > 2e-3f) ++far_off;
    }
  }
  EXPECT_GT(kept, 96 * 72 * 3 / 4);
  EXPECT_LT(far_off, kept / 100);  // at silhouettes
}

TEST_P(AdjustWithCamera, NeedsTwoThatSeeThePixelUnlessThereIsOnlyOne) {
  std::vector<DepthMap> maps = exact_maps({});
  for (std::size_t i = 2; i < maps.size(); ++i) maps[i].depth.setTo(0);
  EXPECT_EQ(cv::countNonZero(adjust_first(maps).depth), 0);
  maps.resize(2);
  EXPECT_GT(cv::countNonZero(adjust_first(maps).depth), 1000);
  maps.resize(1);
  EXPECT_EQ(cv::countNonZero(adjust_first(maps).depth), 0);
}

TEST_P(AdjustWithCamera, RespectsTheDepthRange) {
  std::vector<DepthMap> maps = exact_maps({});
  maps[0].max_depth = maps[0].depth(36, 48);
  const DepthMap result = adjust_first(maps);
  double largest = 0;
  cv::minMaxLoc(result.depth, nullptr, &largest);
  EXPECT_LE(largest, static_cast<double>(maps[0].max_depth));
  EXPECT_GT(cv::countNonZero(result.depth), 100);
}

TEST_P(AdjustWithCamera, GivesTheSameBytesForAnyNumberOfThreads) {
  std::vector<DepthMap> maps = exact_maps({});
  add_noise(maps, 0.004f);
  DepthMap one, two;
  {
    const ThreadLimit limit(1);
    one = adjust_first(maps);
  }
  {
    const ThreadLimit limit(2);
    two = adjust_first(maps);
  }
  EXPECT_TRUE(same(one.depth, two.depth));
  EXPECT_TRUE(same(one.confidence, two.confidence));
}

TEST(Adjust, NamesTheMapThatDoesNotFit) {
  DepthMap map = flat_map(4, 4, 1);
  map.image_path = "odd.jpg";
  map.camera.width = 5;
  try {
    adjust_with_neighbours(map, {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("odd.jpg"));
  }
}

}  // namespace
}  // namespace axial::depth
