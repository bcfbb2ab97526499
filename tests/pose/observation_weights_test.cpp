// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/bundle/observation_weights.h"

#include <gtest/gtest.h>

#include <random>

#include "drawn.h"
#include "pose/adjust/uncertainty.h"
#include "pose/refine.h"
#include "pose/survey.h"

namespace axial::pose {
namespace {

using testing::camera_behind;
using testing::flat_port;
using testing::survey;

// Of every four features, one is coarse, and its place is known 3.5 times worse.
constexpr float kFine = 1, kCoarse = 6;
constexpr double kFineNoise = 0.1, kCoarseNoise = 0.35;

Bundle mixed_features(unsigned seed) {
  Bundle bundle = survey(camera_behind(flat_port(2)), {.points = 400, .seed = seed});
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, 1);
  for (Observation& observation : bundle.observations) {
    const bool coarse = random() % 4 == 0;
    const double spread = coarse ? kCoarseNoise : kFineNoise;
    observation.size = coarse ? kCoarse : kFine;
    observation.pixel += spread * axial::test::drawn<2>(normal, random);
  }
  return bundle;
}

TEST(ObservationWeights, FollowTheErrorsOfEachSize) {
  Bundle bundle = mixed_features(1);
  weigh_by_size(bundle);
  double fine = 0, coarse = 0;
  for (const Observation& observation : bundle.observations)
    (observation.size == kFine ? fine : coarse) = observation.sigma;
  EXPECT_NEAR(coarse / fine, kCoarseNoise / kFineNoise, 0.2);
  EXPECT_LT(fine, 1);
}

TEST(ObservationWeights, AreEqualWithoutSizes) {
  Bundle bundle = mixed_features(1);
  const auto all_equal = [&] {
    weigh_by_size(bundle);
    return std::ranges::all_of(bundle.observations,
                               [](const Observation& one) { return one.sigma == 1; });
  };
  EXPECT_FALSE(all_equal());
  for (Observation& observation : bundle.observations) observation.size = 0;
  EXPECT_TRUE(all_equal());
  for (Observation& observation : bundle.observations) observation.size = 3;
  EXPECT_TRUE(all_equal());
}

TEST(ObservationWeights, OfFewObservationsAreEqual) {
  Bundle bundle = mixed_features(1);
  bundle.observations.resize(399);
  weigh_by_size(bundle);
  for (const Observation& observation : bundle.observations) ASSERT_EQ(observation.sigma, 1);
}

// Errors that grow from 0.1 px at the centre of the photograph by 0.1 px for each 100 px.
TEST(ObservationWeights, FollowTheErrorsAtTheRim) {
  Bundle bundle = survey(camera_behind(flat_port(2)), {.points = 800});
  const Eigen::Vector2d middle = cameras_now(bundle)[0].principal_point();
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(0, 1);
  std::vector<double> radii;
  for (Observation& observation : bundle.observations) {
    radii.push_back((observation.pixel - middle).norm());
    const double spread = 0.1 + 0.001 * radii.back();
    observation.pixel += spread * axial::test::drawn<2>(normal, random);
  }
  weigh_by_size(bundle);
  weigh_by_radius(bundle);
  double nearest = 1e9, farthest = 0, at_nearest = 0, at_farthest = 0;
  for (std::size_t i = 0; i < radii.size(); ++i) {
    if (radii[i] < nearest) nearest = radii[i], at_nearest = bundle.observations[i].sigma;
    if (radii[i] > farthest) farthest = radii[i], at_farthest = bundle.observations[i].sigma;
  }
  // Classes of an eighth of the observations: their medians lie between those of centre and rim.
  EXPECT_GT(at_farthest / at_nearest, 2.5);
  EXPECT_LT(at_farthest / at_nearest, (0.1 + 0.001 * farthest) / (0.1 + 0.001 * nearest));
}

TEST(ObservationWeights, AreAlikeIfErrorsAtTheRimAreNotLarger) {
  Bundle bundle = survey(camera_behind(flat_port(2)), {.points = 800, .noise = 0.2});
  weigh_by_size(bundle);
  weigh_by_radius(bundle);
  // The median of 200 or more errors is known to 5 %.
  for (const Observation& observation : bundle.observations) ASSERT_NEAR(observation.sigma, 1, 0.2);
}

// Over ten draws: the poses are better, and errors are as large as stated.
TEST(ObservationWeights, MakePosesBetter) {
  double with = 0, without = 0, share = 0;
  constexpr int kDraws = 10;
  for (unsigned seed = 1; seed <= kDraws; ++seed) {
    const Bundle truth = survey(camera_behind(flat_port(2)), {.points = 400, .seed = seed});
    const double length = (truth.images[0].pose.centre - truth.images.back().pose.centre).norm();
    RefineOptions options;
    options.adjust.distances.push_back(
        {KnownDistance::Between::images, 0, truth.images.size() - 1, length, 1e-4 * length});
    Bundle weighed = mixed_features(seed), plain = weighed;
    for (Observation& observation : plain.observations) observation.size = 0;
    refine(weighed, options);
    refine(plain, options);
    with += testing::pose_errors(weighed, truth).centre_rms;
    without += testing::pose_errors(plain, truth).centre_rms;
    share += observed_pixel_sigma(weighed, options.adjust) / (kDraws * kFineNoise);
  }
  EXPECT_LT(with, 0.7 * without);
  // The unit is the standard deviation of the median observation, a fine one.
  EXPECT_GT(share, 0.8);
  EXPECT_LT(share, 2);
}

}  // namespace
}  // namespace axial::pose
