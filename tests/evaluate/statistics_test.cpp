// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/statistics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace axial::evaluate {
namespace {

TEST(Statistics, OfFiveDistances) {
  const std::vector<float> distances{4, 0, 1, 2, 8};
  const DistanceStatistics s = summarise(distances);
  EXPECT_EQ(s.count, 5u);
  EXPECT_DOUBLE_EQ(s.mean, 3);
  EXPECT_DOUBLE_EQ(s.median, 2);
  EXPECT_DOUBLE_EQ(s.rms, std::sqrt(85.0 / 5));
  EXPECT_DOUBLE_EQ(s.variance, 8);  // 17 - 9
  EXPECT_DOUBLE_EQ(s.max, 8);
  // The 75th percentile is the fourth value; the 90th is 0.6 of the way to the last value.
  EXPECT_DOUBLE_EQ(s.percentiles[1], 4);
  EXPECT_DOUBLE_EQ(s.percentiles[2], 4 + 0.6 * 4);
}

TEST(Statistics, OfNothingAreZero) {
  const DistanceStatistics s = summarise({});
  EXPECT_EQ(s.count, 0u);
  EXPECT_EQ(s.mean, 0);
  EXPECT_EQ(s.max, 0);
}

TEST(Histogram, CountsEveryDistanceOnce) {
  const std::vector<float> distances{0, 0.5f, 1, 1.5f, 3.999f, 4, 100};
  const Histogram h = histogram(distances, 4, 4);
  EXPECT_THAT(h.counts, testing::ElementsAre(2, 2, 0, 1));
  EXPECT_EQ(h.beyond, 2u);
}

TEST(Score, ByHand) {
  // 3 of 4 points are right and 1 of 2 samples is found: F = 2 * 3/4 * 1/2 / (5/4) = 0.6.
  const std::vector<float> to_truth{0, 0.25f, 0.5f, 0.75f}, to_reconstruction{0.5f, 0.51f};
  const Score s = score(to_truth, to_reconstruction, 0.5);
  EXPECT_DOUBLE_EQ(s.precision, 0.75);
  EXPECT_DOUBLE_EQ(s.recall, 0.5);
  EXPECT_DOUBLE_EQ(s.f_score, 0.6);
  EXPECT_EQ(score_of(1, 0, 0).f_score, 0);
}

}  // namespace
}  // namespace axial::evaluate
