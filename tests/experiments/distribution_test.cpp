// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/distribution.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace axial::experiments {
namespace {

// Compares with the sorted list: equal up to the width of a bin.
TEST(Distribution, AgreesWithTheSortedErrors) {
  std::mt19937 random(1);
  std::exponential_distribution<double> draw(3);
  std::vector<double> errors(20000);
  for (double& error : errors) error = draw(random);
  Distribution first(1, 200), second(1, 200);
  for (std::size_t k = 0; k < errors.size(); ++k) (k % 3 ? first : second).add(errors[k]);
  first.merge(second);

  std::sort(errors.begin(), errors.end());
  const double count = static_cast<double>(errors.size());
  EXPECT_EQ(first.count(), 20000);
  EXPECT_NEAR(first.mean(), std::accumulate(errors.begin(), errors.end(), 0.0) / count, 1e-12);
  EXPECT_EQ(first.largest(), errors.back());
  for (const double q : {0.05, 0.5, 0.9})
    EXPECT_NEAR(first.quantile(q), errors[static_cast<std::size_t>(q * count)], 1.0 / 200) << q;
  const auto beyond = errors.end() - std::lower_bound(errors.begin(), errors.end(), 1.0);
  EXPECT_GT(beyond, 100);
  EXPECT_EQ(first.beyond(), beyond);
  EXPECT_EQ(first.quantile(0.999), errors.back());  // beyond the bins
  EXPECT_EQ(std::accumulate(first.counts().begin(), first.counts().end(), first.beyond()), 20000);
}

}  // namespace
}  // namespace axial::experiments
