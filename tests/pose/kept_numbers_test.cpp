// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/adjust/kept_numbers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

#include "pose/adjust/uncertainty.h"

namespace axial::pose {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

NumbersCovariance with(const Eigen::MatrixXd& covariance) {
  NumbersCovariance numbers;
  numbers.covariance = covariance;
  for (int k = 0; k < covariance.rows(); ++k) numbers.numbers.push_back({0, k});
  return numbers;
}

// Units are metres and radians: the rule must not depend on them.
TEST(KeptNumbers, AreThoseWithinTheirNoise) {
  const Eigen::Vector4d sigmas(1e-6, 2, 0.03, 500);
  const Eigen::Vector4d changes(2.4e-6, -5, 0.06, 1300);  // 2.4, 2.5, 2 and 2.6 deviations
  const auto numbers = with(sigmas.cwiseAbs2().asDiagonal());
  EXPECT_THAT(numbers_to_keep(numbers, changes), ElementsAre(0, 2));
}

// Index and focal length look alike: each could explain the other's error, so that either of them
// goes back to its stated value, but not both.
TEST(KeptNumbers, OneOfTwoThatLookAlikeExplainsAnError) {
  Eigen::Matrix2d covariance;
  covariance << 1, -0.999, -0.999, 1;
  const Eigen::Vector2d along(1.5, -1.5), across(0.5, 0.5);
  EXPECT_THAT(numbers_to_keep(with(covariance), along), ElementsAre(0, 1));
  EXPECT_EQ(numbers_to_keep(with(covariance), across).size(), 1u);
}

TEST(KeptNumbers, AreNotThoseWithoutAMeasuredValue) {
  const Eigen::Vector2d changes(std::numeric_limits<double>::infinity(), 0.5);
  EXPECT_THAT(numbers_to_keep(with(Eigen::Matrix2d::Identity()), changes), ElementsAre(1));
  EXPECT_THAT(numbers_to_keep(NumbersCovariance{}, Eigen::VectorXd()), IsEmpty());
}

// The least cost of the numbers that stay free, by solving their equations.
double cost_without(const std::vector<std::size_t>& kept, const Eigen::MatrixXd& information,
                    const Eigen::VectorXd& changes) {
  std::vector<Eigen::Index> fixed(kept.begin(), kept.end()), open;
  for (Eigen::Index i = 0; i < changes.size(); ++i)
    if (std::ranges::find(fixed, i) == fixed.end()) open.push_back(i);
  Eigen::VectorXd away = Eigen::VectorXd::Zero(changes.size());
  away(fixed) = -changes(fixed);
  if (!open.empty())
    away(open) = -Eigen::MatrixXd(information(open, open)).inverse() * information(open, fixed) *
                 away(fixed);
  return away.dot(information * away);
}

// Keeping another number, or one of the kept numbers last, costs what the rule says.
TEST(KeptNumbers, CostNoMoreThanNoiseWould) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0, 1);
  const auto draw = [&] { return normal(random); };
  int several = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(6, 5, draw);
    const Eigen::MatrixXd information = root.transpose() * root;
    const Eigen::MatrixXd covariance = information.inverse();
    const Eigen::VectorXd changes = 2.5 * Eigen::VectorXd::NullaryExpr(5, draw).cwiseProduct(
                                              Eigen::VectorXd(covariance.diagonal().cwiseSqrt()));
    const auto kept = numbers_to_keep(with(covariance), changes);
    const double cost = cost_without(kept, information, changes);
    EXPECT_LE(cost, 6.0 * static_cast<double>(kept.size()) + 1e-6);
    for (std::size_t i = 0; i < 5; ++i) {
      if (std::ranges::find(kept, i) != kept.end()) continue;
      std::vector<std::size_t> more = kept;
      more.push_back(i);
      EXPECT_GT(cost_without(more, information, changes), cost + 6 - 1e-6);
    }
    several += kept.size() > 1 ? 1 : 0;
  }
  EXPECT_GT(several, 20);
}

}  // namespace
}  // namespace axial::pose
