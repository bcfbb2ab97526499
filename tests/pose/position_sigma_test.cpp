// SPDX-License-Identifier: GPL-3.0-or-later
// Known positions: wrong ones are found, and the accuracy of the others is estimated.
#include "pose/adjust/position_sigma.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "drawn.h"
#include "pose/bundle/known.h"
#include "pose/survey.h"
#include "scene/decompositions.h"

namespace axial::pose {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using Positions = std::vector<KnownPosition>;

constexpr double kPositionNoise = 0.05;  // [m]

Bundle cameras(int images) {
  return testing::survey(testing::camera_behind(testing::flat_port()),
                         {.distance = 3, .images = images, .points = 20});
}

// The true positions of all cameras with noise, none with a stated standard deviation.
Positions positions_of(const Bundle& truth, double sigma, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0, 1);
  Positions positions;
  for (std::size_t i = 0; i < truth.images.size(); ++i) {
    const Eigen::Vector3d off = axial::test::drawn<3>(noise, random);
    positions.push_back(
        {i, truth.images[i].pose.centre + sigma * off, Eigen::Vector3d::Constant(0.1), true});
  }
  return positions;
}

// The same cameras in another place and at another scale.
Bundle moved(Bundle bundle) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(1, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  for (BundleImage& image : bundle.images)
    image.pose.centre = 1.2 * turn * image.pose.centre + Eigen::Vector3d(5, -3, 2);
  return bundle;
}

class PositionsOfImages : public ::testing::TestWithParam<int> {};

TEST_P(PositionsOfImages, HaveTheStandardDeviationOfTheirNoise) {
  constexpr int kDraws = 400;
  const Bundle truth = cameras(GetParam()), bundle = moved(truth);
  double variance = 0;
  for (unsigned draw = 0; draw < kDraws; ++draw) {
    Positions positions = positions_of(truth, kPositionNoise, draw);
    EXPECT_THAT(judge_positions(bundle, 1, positions), IsEmpty());
    const double sigma = positions[0].sigma.x();
    variance += sigma * sigma / kDraws;
    for (const KnownPosition& known : positions)
      ASSERT_EQ(known.sigma, Eigen::Vector3d::Constant(sigma));
  }
  // Unbiased but for the one degree of freedom less.
  const double free = 3.0 * GetParam() - 7;
  const double expected = kPositionNoise * kPositionNoise * free / (free - 1);
  EXPECT_NEAR(variance, expected, 4 * expected * std::sqrt(2 / free / kDraws) + 0.03 * expected);
}

// The scale of positions is off by their standard deviation divided by their spread.
TEST_P(PositionsOfImages, StateTheScaleHonestly) {
  constexpr int kDraws = 1000;
  const Bundle truth = cameras(GetParam());
  int within = 0;
  for (unsigned draw = 0; draw < kDraws; ++draw) {
    Positions positions = positions_of(truth, kPositionNoise, draw);
    const auto [centres, places] = centres_and_positions(truth, positions);
    const double spread = (centres.colwise() - centres.rowwise().mean()).norm();
    judge_positions(truth, 1, positions);
    const double off = best_similarity(centres, places).scale - 1;
    within += std::abs(off) < 3 * positions[0].sigma.x() / spread;
  }
  EXPECT_GE(within, 0.94 * kDraws);  // 95 % with a standard deviation of 0.7 %
}

INSTANTIATE_TEST_SUITE_P(Of, PositionsOfImages, ::testing::Values(3, 4, 6, 10, 30),
                         ::testing::PrintToStringParamName());

TEST(JudgePositions, KeepsWhatWasStated) {
  const Bundle truth = cameras(12);
  Positions positions = positions_of(truth, kPositionNoise, 1);
  for (std::size_t i = 0; i < positions.size(); i += 2) {
    positions[i].sigma_is_guess = false;
    positions[i].sigma.setConstant(0.07);
  }
  judge_positions(truth, 1, positions);
  for (std::size_t i = 0; i < positions.size(); i += 2) {
    EXPECT_EQ(positions[i].sigma.x(), 0.07);
    EXPECT_NEAR(positions[i + 1].sigma.x(), kPositionNoise, 0.02);
  }
}

TEST(JudgePositions, GivesExactPositionsTheLeastStandardDeviation) {
  const Bundle truth = cameras(12);
  Positions positions = positions_of(truth, 0, 1);
  judge_positions(truth, 3, positions);
  EXPECT_EQ(positions[4].sigma, Eigen::Vector3d::Constant(kLeastPositionSigma));
}

TEST(JudgePositions, MultipliesTheEstimate) {
  const Bundle truth = cameras(12);
  Positions once = positions_of(truth, kPositionNoise, 1), three = once;
  judge_positions(truth, 1, once);
  judge_positions(truth, 3, three);
  EXPECT_NEAR(three[0].sigma.x(), 3 * once[0].sigma.x(), 1e-12);
}

TEST(JudgePositions, RemovesAWrongOneAndNamesIt) {
  const Bundle truth = cameras(12);
  Positions positions = positions_of(truth, 0.01, 1);
  positions[4].metres.x() += 1.2;
  const std::vector<std::string> lines = judge_positions(moved(truth), 1, positions);
  ASSERT_THAT(lines, SizeIs(1));
  EXPECT_THAT(lines[0], HasSubstr("the position of image4.jpg is 1.2"));
  ASSERT_THAT(positions, SizeIs(11));
  for (const KnownPosition& known : positions) EXPECT_NE(known.image, 4u);
  EXPECT_NEAR(positions[0].sigma.x(), 0.01, 0.004);
}

// Six standard deviations are too few to call a position wrong.
TEST(JudgePositions, CountsALargeDistanceLittle) {
  const Bundle truth = cameras(12);
  Positions positions = positions_of(truth, kPositionNoise, 1);
  positions[4].metres.x() += 6 * kPositionNoise;
  EXPECT_THAT(judge_positions(truth, 1, positions), IsEmpty());
  EXPECT_LT(positions[0].sigma.x(), 1.4 * kPositionNoise);
}

// The centre of an image without observations is not that of a photograph.
TEST(JudgePositions, DoesNotCountImagesWithoutObservations) {
  Bundle bundle = cameras(12);
  Positions all = positions_of(bundle, kPositionNoise, 1), rest = all;
  rest.erase(rest.begin() + 4);
  std::erase_if(bundle.observations, [](const Observation& one) { return one.image == 4; });
  bundle.images[4].pose.centre = all[4].metres + Eigen::Vector3d(100, 0, 0);
  EXPECT_THAT(judge_positions(bundle, 1, all), IsEmpty());
  judge_positions(bundle, 1, rest);
  ASSERT_THAT(all, SizeIs(12));
  EXPECT_EQ(all[0].sigma, rest[0].sigma);
  EXPECT_EQ(position_distances(bundle, all).count, 11u);
  EXPECT_LT(position_distances(bundle, all).rms, 1);
}

TEST(JudgePositions, LeavesTwoAsTheyAre) {
  const Bundle truth = cameras(12);
  Positions positions = positions_of(truth, kPositionNoise, 1);
  positions.resize(2);
  EXPECT_THAT(judge_positions(truth, 1, positions), IsEmpty());
  EXPECT_EQ(positions[0].sigma.x(), 0.1);
}

TEST(PositionDistances, CompareWithWhatWasStated) {
  const Bundle truth = cameras(30);
  Positions positions = positions_of(truth, kPositionNoise, 1);
  EXPECT_EQ(position_distances(truth, positions).of_stated, 0);
  EXPECT_NEAR(position_distances(truth, positions).rms, std::sqrt(3.0) * kPositionNoise,
              0.1 * kPositionNoise);
  for (KnownPosition& known : positions) {
    known.sigma_is_guess = false;
    known.sigma.setConstant(kPositionNoise);
  }
  EXPECT_NEAR(position_distances(truth, positions).of_stated, 1, 0.15);
  Positions same = positions;
  correct_contradicted(position_distances(truth, same), same);
  EXPECT_EQ(same[0].sigma.x(), kPositionNoise);
  for (KnownPosition& known : positions) known.sigma.setConstant(kPositionNoise / 10);
  correct_contradicted(position_distances(truth, positions), positions);
  EXPECT_NEAR(positions[0].sigma.x(), kPositionNoise, 0.15 * kPositionNoise);
}

}  // namespace
}  // namespace axial::pose
