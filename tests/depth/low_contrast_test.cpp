// SPDX-License-Identifier: GPL-3.0-or-later
// Matching where the texture is hardly stronger than the noise: in haze, and on smooth surfaces.
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "depth/matching_survey.h"

namespace axial::depth {
namespace {

// The survey in haze: the contrast is multiplied by `contrast`, then camera noise is added.
Survey hazy(Survey survey, double contrast) {
  cv::RNG random(5);
  for (MatchImage& view : survey.views) {
    cv::Mat1f grey, noise(view.grey.size());
    view.grey.convertTo(grey, CV_32F, contrast, 110);
    random.fill(noise, cv::RNG::NORMAL, 0, 1);
    cv::Mat1f(grey + noise).convertTo(view.grey, CV_8U);
  }
  return survey;
}

TEST(PatchMatch, CoarserLevelsCostNoAccuracyInHaze) {
  const Survey survey = hazy(make_survey(Kind::flat_port), 1.0 / 7);
  PatchMatchOptions options;
  options.coarsest_side = 30;
  // Means over all views, because different paths of the random search change the errors of one
  // view by a tenth.
  const auto errors_on = [&](int levels) {
    options.sub_resolution_levels = levels;
    Errors sum;
    for (std::size_t i = 0; i < survey.views.size(); ++i) {
      std::vector<const MatchImage*> sources;
      const MatchInput input = survey.input(i, sources);
      const Errors errors = compare(estimate_depth_map(input, options), survey.truth[i]);
      sum.median_relative += errors.median_relative;
      sum.valid_fraction += errors.valid_fraction;
    }
    return sum;
  };
  const Errors none = errors_on(0);
  for (const int levels : {1, 2}) {
    const Errors more = errors_on(levels);
    // With a strong prior, the errors were 1.4 times (one level) and 3 times (two levels) as large.
    EXPECT_LT(more.median_relative, 1.2 * none.median_relative) << levels;
    EXPECT_GT(more.valid_fraction, 0.99 * none.valid_fraction) << levels;
  }
}

// Smooth texture about as strong as the noise, whose standard deviation is one grey level.
Survey weakly_textured() {
  Survey smooth = make_survey(Kind::flat_port);
  for (MatchImage& view : smooth.views) cv::GaussianBlur(view.grey, view.grey, {}, 3);
  return hazy(smooth, 0.3);
}

TEST(PatchMatch, CoarserLevelsHoldWhatHasHardlyMoreTextureThanNoise) {
  const Survey survey = weakly_textured();
  std::vector<const MatchImage*> sources;
  const MatchInput input = survey.input(0, sources);
  PatchMatchOptions options;
  options.coarsest_side = 30;
  options.min_texture = 4e-4f;  // with less texture, only the coarser level can give a depth
  const auto errors = [&] { return compare(estimate_depth_map(input, options), survey.truth[0]); };
  const Errors held = errors();
  options.prior_texture = 1e-9f;
  const Errors free = errors();
  options.sub_resolution_levels = 0;
  const Errors none = errors();
  // The windows of a coarser level cover twice the width, and its noise is half as strong.
  // Measured: 0.7 times the error, and depths for 12 % more of the pixels.
  EXPECT_LT(held.median_relative, 0.85 * free.median_relative);
  EXPECT_GT(held.valid_fraction, none.valid_fraction + 0.05);
}

// With OpenMVS's threshold, pixels whose depths are as accurate as others are lost.
TEST(PatchMatch, KeepsWhatHasHardlyMoreTextureThanNoise) {
  const Survey survey = weakly_textured();
  std::vector<const MatchImage*> sources;
  const MatchInput input = survey.input(0, sources);
  PatchMatchOptions options;
  options.sub_resolution_levels = 0;
  const Errors all = compare(estimate_depth_map(input, options), survey.truth[0]);
  options.min_texture = 4e-4f;
  const Errors strong = compare(estimate_depth_map(input, options), survey.truth[0]);
  EXPECT_GT(all.valid_fraction, 0.99);
  EXPECT_LT(strong.valid_fraction, 0.95);
  EXPECT_LT(all.median_relative, 1.1 * strong.median_relative);  // measured: 1.01
}

}  // namespace
}  // namespace axial::depth
