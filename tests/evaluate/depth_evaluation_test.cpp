// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/depth_evaluation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "scene/camera_model.h"

namespace axial::evaluate {
namespace {

// The range of the plane n.X = 1 at every pixel of a pinhole whose focal length is half the width.
cv::Mat1f plane_range(int width, int height) {
  CameraModel model{400, 300, {200, 200, 199.5, 149.5}, {}};
  const refractive::PinholeCamera<double> camera(model.resized(width, height).lens);
  cv::Mat1f range(height, width);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
      range(v, u) =
          static_cast<float>(1 / Eigen::Vector3d(0.2, -0.3, 0.7).dot(camera.ray({u, v}).direction));
  return range;
}

TEST(EvaluateDepth, OfAPlaneWithAKnownError) {
  const cv::Mat1f truth = plane_range(80, 60);
  cv::Mat1f estimate = truth.clone();
  estimate += 0.004f;
  estimate(cv::Rect(0, 0, 80, 30)) -= 0.005f;  // the upper half is 1 mm short
  estimate(cv::Rect(0, 0, 20, 60)) = 0;        // a quarter has no depth
  DepthOptions options;
  options.tolerances = {0.002, 0.01};
  const DepthEvaluation e = evaluate_depth(estimate, truth, options);
  const double rounding = 1e-6;  // of depths around 1 to 3 m in float
  EXPECT_EQ(e.truth_pixels, 4800u);
  EXPECT_EQ(e.estimated_pixels, 3600u);
  EXPECT_EQ(e.compared_pixels, 3600u);
  EXPECT_DOUBLE_EQ(e.completeness, 0.75);
  EXPECT_NEAR(e.accuracy.mean, 0.0025, rounding);
  EXPECT_NEAR(e.signed_mean, 0.0015, rounding);
  EXPECT_NEAR(e.accuracy.max, 0.004, rounding);
  EXPECT_DOUBLE_EQ(e.scores[0].precision, 0.5);
  EXPECT_DOUBLE_EQ(e.scores[0].recall, 0.375);
  EXPECT_NEAR(e.scores[0].f_score, 2 * 0.5 * 0.375 / 0.875, 1e-12);
  EXPECT_DOUBLE_EQ(e.scores[1].recall, 0.75);
  EXPECT_TRUE(std::isnan(e.error(0, 0)));
  EXPECT_NEAR(e.error(0, 79), -0.001, rounding);
}

// An error that grows by 0.0005 per ring is added to walls at different distances. The distances
// must not matter, and each ring's median must be that of the pixels counted one by one.
TEST(EvaluateDepth, RelativeRingsPoolMapsAndForgetTheDistance) {
  std::vector<DepthEvaluation> maps;
  for (const float distance : {0.5f, 2.0f, 4.0f}) {
    const cv::Mat1f truth(90, 120, distance);
    cv::Mat1f estimate = truth.clone();
    for (int v = 0; v < 90; ++v)
      for (int u = 0; u < 120; ++u) {
        const auto ring = std::floor(std::hypot(u - 59.5, v - 44.5) / 75 * 8);
        estimate(v, u) *= 1 + 0.0005f * static_cast<float>(ring);
      }
    estimate(cv::Rect(0, 0, 120, 10)) = 0;  // no depth, so it must not count
    maps.push_back(evaluate_depth(estimate, truth, {}));
  }
  const auto rings = relative_rings(maps, 8);
  ASSERT_EQ(rings.size(), 8u);
  std::size_t pixels = 0;
  for (std::size_t k = 0; k < 8; ++k) {
    EXPECT_NEAR(rings[k].signed_median, 0.0005 * static_cast<double>(k), 3e-7);  // float depths
    EXPECT_DOUBLE_EQ(rings[k].outer - rings[k].inner, 0.125);
    pixels += rings[k].count;
  }
  EXPECT_EQ(pixels, 3u * 80u * 120u);
  EXPECT_EQ(rings[0].count, 3 * maps[0].rings[0].count);
  EXPECT_NE(maps[0].rings[7].signed_median, maps[1].rings[7].signed_median);
}

TEST(EvaluateDepth, RelativeRingsOfNothingAreEmpty) {
  for (const RelativeRing& ring : relative_rings({}, 8)) EXPECT_EQ(ring.count, 0u);
}

TEST(EvaluateDepth, RingsShowARadialError) {
  const cv::Mat1f truth(90, 120, 2.0f);
  cv::Mat1f estimate = truth.clone();
  const double half_diagonal = 75;
  for (int v = 0; v < 90; ++v)
    for (int u = 0; u < 120; ++u)
      estimate(v, u) -= 0.016f * static_cast<float>(std::hypot(u - 59.5, v - 44.5) / half_diagonal);
  const DepthEvaluation e = evaluate_depth(estimate, truth, {});
  ASSERT_EQ(e.rings.size(), 8u);
  std::size_t pixels = 0;
  for (std::size_t k = 0; k < 8; ++k) {
    pixels += e.rings[k].count;
    // The error changes by 2 mm across each ring.
    EXPECT_LE(e.rings[k].signed_median, -0.002 * static_cast<double>(k) + 1e-6);
    EXPECT_GE(e.rings[k].signed_median, -0.002 * static_cast<double>(k + 1) - 1e-6);
    EXPECT_NEAR(e.rings[k].absolute_median, -e.rings[k].signed_median, 1e-9);
  }
  EXPECT_EQ(pixels, 90u * 120u);
}

TEST(ResampleDistance, ReadsAPlaneOffBetweenPixels) {
  for (const auto& [width, height] : {std::pair{400, 300}, {200, 150}, {133, 100}, {100, 75}}) {
    const cv::Mat1f truth = plane_range(width, height);
    const cv::Mat1f expected = plane_range(100, 75);
    const cv::Mat1f found = resample_distance(truth, {100, 75});
    // 1/range is not exactly linear between pixels. For comparison, a shift by a quarter pixel on a
    // slope of 1 % per pixel would give 5e-3.
    EXPECT_LT(cv::norm(found, expected, cv::NORM_INF), 1.2e-4 * 400 / width) << width;
  }
}

TEST(ResampleDistance, DoesNotMixAcrossEdgesOrHoles) {
  cv::Mat1f truth(60, 80, 1.0f);
  truth(cv::Rect(41, 0, 39, 60)) = 2;  // an edge between pixels of one coarse pixel
  truth(cv::Rect(0, 0, 80, 11)) = 0;
  const cv::Mat1f half = resample_distance(truth, {40, 30});
  for (const float value : half) EXPECT_TRUE(value == 0 || value == 1 || value == 2) << value;
}

TEST(EvaluateDepth, IgnoresWhatIsNotADistance) {
  cv::Mat1f truth(10, 10, 1.0f), estimate(10, 10, 1.5f);
  truth(0, 0) = std::numeric_limits<float>::quiet_NaN();
  truth(0, 1) = std::numeric_limits<float>::infinity();
  truth(0, 2) = -1;
  estimate(1, 0) = std::numeric_limits<float>::quiet_NaN();
  const DepthEvaluation e = evaluate_depth(estimate, truth, {});
  EXPECT_EQ(e.truth_pixels, 97u);
  EXPECT_EQ(e.compared_pixels, 96u);
  EXPECT_DOUBLE_EQ(e.accuracy.max, 0.5);
}

TEST(EvaluateDepth, RefusesWhatCannotBeCompared) {
  const cv::Mat1f map(60, 80, 1.0f);
  EXPECT_THROW(evaluate_depth({}, map, {}), Error);
  EXPECT_THROW(evaluate_depth(map, {}, {}), Error);
  EXPECT_THROW(evaluate_depth(map, cv::Mat1f(80, 60, 1.0f), {}), Error);
  EXPECT_THROW(evaluate_depth(map, cv::Mat1f(60, 80, 0.0f), {}), Error);
  DepthOptions options;
  options.tolerances = {0};
  EXPECT_THROW(evaluate_depth(map, map, options), Error);
}

}  // namespace
}  // namespace axial::evaluate
