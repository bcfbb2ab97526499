// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/order_statistics.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace axial {
namespace {

RC_GTEST_PROP(OrderStatistics, AreThoseOfTheSortedValues, (const std::vector<int>& values)) {
  RC_PRE(!values.empty());
  std::vector<int> sorted = values;
  std::ranges::sort(sorted);
  for (std::size_t place = 0; place < values.size(); ++place)
    RC_ASSERT(value_at_place(values, place) == sorted[place]);
  RC_ASSERT(upper_median(values) == sorted[values.size() / 2]);
  RC_ASSERT(lower_quantile(values, 0) == sorted.front());
  RC_ASSERT(lower_quantile(values, 0.5) == sorted[(values.size() - 1) / 2]);
  RC_ASSERT(lower_quantile(values, 1) == sorted.back());
  RC_ASSERT(interpolated_quantile<int>(sorted, 1) == sorted.back());
  std::vector<int> moved = values;
  RC_ASSERT(upper_median_of_moved(moved) == upper_median(values));
}

TEST(OrderStatistics, OfNoValuesAreZero) {
  EXPECT_EQ(upper_median(std::vector<double>{}), 0);
  EXPECT_EQ(lower_quantile(std::vector<float>{}, 0.75), 0);
  EXPECT_EQ(mean_median(std::vector<float>{}), 0);
  EXPECT_EQ(robust_deviation({}), 0);
}

TEST(OrderStatistics, BetweenTwoValuesAreInterpolatedOnDemand) {
  EXPECT_EQ(mean_median(std::vector{4.0, 1.0, 3.0, 2.0}), 2.5);
  EXPECT_EQ(interpolated_quantile<double>(std::vector{1.0, 2.0, 4.0}, 0.75), 3);
}

TEST(OrderStatistics, OutliersDoNotMatterForTheRobustDeviation) {
  EXPECT_DOUBLE_EQ(robust_deviation({1, 2, 3, 4, 1000}), kSigmasOfMedian);
}

TEST(OrderStatistics, TheDeviationAboutZeroKeepsTheMean) {
  EXPECT_DOUBLE_EQ(deviation_about_zero({3, -2, 3, 4, -1000}), 3 * kSigmasOfMedian);
  EXPECT_EQ(deviation_about_zero({}), 0);
}

TEST(OrderStatistics, OfAnEvenNumberAreOneOfTheTwoInTheMiddle) {
  EXPECT_EQ(upper_median(std::vector{4.0, 1.0, 3.0, 2.0}), 3);
  EXPECT_EQ(lower_quantile(std::vector{4.0, 1.0, 3.0, 2.0}, 0.5), 2);
}

}  // namespace
}  // namespace axial
