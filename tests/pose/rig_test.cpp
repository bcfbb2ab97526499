// SPDX-License-Identifier: GPL-3.0-or-later
// Rigs in bundle adjustment: their poses, the scale that they give, and cameras that are late.
#include "pose/bundle/rig.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "pose/adjust/adjust.h"
#include "pose/adjust/uncertainty.h"
#include "pose/bundle/rig_fit.h"
#include "pose/refine.h"
#include "pose/rig_survey.h"

namespace axial::pose {
namespace {

using testing::absorbed;
using testing::disturb;
using testing::known_length;
using testing::pose_errors;
using testing::rig_survey;
using testing::RigSurveyOptions;
using testing::true_rig;
using Known = RigCamera::Known;

// The survey from the poses of a pinhole engine, refined with its rig.
Bundle refined(const Bundle& truth, const Rig& rig) {
  Bundle bundle = absorbed(truth, 7.3);
  bundle.rigs = {rig};
  RefineOptions options;
  bring_to_metres(bundle, options.adjust);
  refine(bundle, options);
  return bundle;
}

TEST(Rig, RelativePoseTakesThePlaceOfTheReference) {
  const RigSurveyOptions options;
  const Bundle truth = rig_survey(options);
  const Pose found = relative_pose(truth.images[1].pose, truth.images[0].pose);
  EXPECT_TRUE(found.rotation.isApprox(testing::right_in_rig(options).rotation, 1e-12));
  EXPECT_TRUE(found.centre.isApprox(testing::right_in_rig(options).centre, 1e-12));
}

// The numbers of a free camera follow from exact observations and a known length.
TEST(Rig, FindsAFreePoseFromExactObservations) {
  const RigSurveyOptions options;
  const Bundle truth = rig_survey(options);
  Bundle bundle = truth;
  bundle.rigs = {true_rig(options, Known::free)};
  disturb(bundle, 0.003, 0.003, 5);
  start_rigs(bundle);
  AdjustOptions adjusting;
  adjusting.distances = {known_length(truth)};
  adjust(bundle, adjusting);
  const Pose& found = bundle.rigs[0].cameras[1].now;
  EXPECT_LT((found.centre - options.base).norm(), 1e-5);
  EXPECT_LT(Eigen::AngleAxisd(found.rotation.transpose() * testing::right_in_rig(options).rotation)
                .angle(),
            1e-5);
  const RigFit fit = fit_of(bundle, bundle.rigs[0], 1);
  EXPECT_EQ(fit.frames, 12u);
  EXPECT_LT(fit.translation_rms, 1e-5);
  EXPECT_LT(fit.rotation_rms, 1e-5);
  EXPECT_NEAR(fit.speed, options.speed, 0.01);
  const Uncertainty known = uncertainty(bundle, adjusting);
  EXPECT_LT(known.rig_sigmas[0][1].translation.maxCoeff(), 0.001);
  EXPECT_GT(known.rig_sigmas[0][1].translation.minCoeff(), 0);
  EXPECT_EQ(known.rig_sigmas[0][0].translation.norm(), 0);
}

// With other lengths, the scale of the poses is that of the base. 0.1 % is the accuracy that is
// promised.
TEST(Rig, StatedBaseGivesTheScale) {
  for (const Known known : {Known::stated, Known::fixed})
    for (const Eigen::Vector3d& base : {Eigen::Vector3d(0.2, 0, 0), Eigen::Vector3d(0, 0.2, 0)}) {
      const RigSurveyOptions options{.base = base, .noise = 0.3, .seed = 7};
      const Bundle truth = rig_survey(options);
      const Bundle found = refined(truth, true_rig(options, known));
      EXPECT_NEAR(pose_errors(found, truth).scale, 1, 0.001);
      EXPECT_FALSE(fit_of(found, found.rigs[0], 1).is_late());
    }
}

// 40 ms at 0.3 m/s are 12 mm. The delay is found, and the model keeps its scale.
TEST(Rig, LateCameraIsFoundAndKeepsTheScale) {
  for (const double delay : {0.04, -0.04}) {
    const RigSurveyOptions options{.delay = delay, .noise = 0.3, .seed = 3};
    const Bundle truth = rig_survey(options);
    const Bundle found = refined(truth, true_rig(options, Known::stated));
    const RigFit fit = fit_of(found, found.rigs[0], 1);
    EXPECT_TRUE(fit.is_late());
    EXPECT_NEAR(fit.delay, delay, 0.003);
    Bundle again = found;
    EXPECT_FALSE(set_delays(again)) << "a part of the delay is not found yet";
    EXPECT_LT(fit.delay_sigma, 0.003);
    EXPECT_NEAR(pose_errors(found, truth).scale, 1, 0.001);
  }
}

// Along the track of a rig that does not turn, a wrong base and a delay look the same.
TEST(Rig, DelayAlongTheBaseIsNotKnown) {
  const RigSurveyOptions options{.base = {0.2, 0, 0}, .delay = 0.04, .sway = 0, .noise = 0.3};
  const Bundle truth = rig_survey(options);
  const Bundle found = refined(truth, true_rig(options, Known::stated));
  const RigFit fit = fit_of(found, found.rigs[0], 1);
  EXPECT_FALSE(fit.is_late());
  EXPECT_GT(fit.delay_sigma, 0.01);
}

// A photograph of another frame does not bend the model, and is named.
TEST(Rig, WrongFrameDoesNotChangeTheScale) {
  const RigSurveyOptions options{.noise = 0.3, .seed = 4};
  const Bundle truth = rig_survey(options);
  Rig rig = true_rig(options, Known::stated);
  std::swap(rig.frames[4].images[1].image, rig.frames[5].images[1].image);
  const Bundle found = refined(truth, rig);
  EXPECT_NEAR(pose_errors(found, truth).scale, 1, 0.001);
  const RigFit fit = fit_of(found, found.rigs[0], 1);
  EXPECT_EQ(fit.wrong, (std::vector<std::size_t>{4, 5}));
  EXPECT_LT(fit.translation_rms, 0.0005);
}

// Errors of the stated base are errors of the scale, and the standard deviation of the scale says
// so: its mean square over 30 draws has a relative standard deviation of 26 %.
TEST(Rig, StandardDeviationOfTheScaleIncludesTheBase) {
  const RigSurveyOptions options{.points = 120, .noise = 0.3};
  constexpr double kSigma = 0.001;
  constexpr int kDraws = 30;
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal(0, 1);
  double sum = 0;
  for (unsigned draw = 0; draw < kDraws; ++draw) {
    RigSurveyOptions drawn = options;
    drawn.seed = 100 + draw;
    const Bundle truth = rig_survey(drawn);
    Bundle bundle = truth;
    bundle.rigs = {true_rig(drawn, Known::stated)};
    RigCamera& right = bundle.rigs[0].cameras[1];
    right.sigma_translation = kSigma;
    for (double& number : right.stated.centre) number += kSigma * normal(random);
    start_rigs(bundle);
    AdjustOptions adjusting;
    adjusting.pixel_sigma = 0.3;
    adjusting.loss_sigmas = 10;
    adjust(bundle, adjusting);
    const double error = std::log(pose_errors(bundle, truth).scale);
    const double sigma = uncertainty(bundle, adjusting).scale_sigma;
    EXPECT_GT(sigma, 0.5 * kSigma / 0.2);
    sum += error * error / (sigma * sigma);
  }
  EXPECT_NEAR(std::sqrt(sum / kDraws), 1, 0.4);
}

TEST(Rig, PhotographsWithoutObservationsLeaveTheirFrames) {
  const RigSurveyOptions options;
  Bundle bundle = rig_survey(options);
  bundle.rigs = {true_rig(options, Known::stated)};
  std::erase_if(bundle.observations, [](const Observation& one) { return one.image == 5; });
  leave_out_unobserved(bundle);
  EXPECT_EQ(bundle.rigs[0].frames[2].images.size(), 1u);
  EXPECT_EQ(bundle.rigs[0].frames[3].images.size(), 2u);
}

TEST(Rig, FreePosesGiveNoScale) {
  const RigSurveyOptions options;
  Bundle bundle = rig_survey(options);
  bundle.rigs = {true_rig(options, Known::free)};
  EXPECT_EQ(scale_by_rigs(bundle), 0);
  bundle.rigs = {true_rig(options, Known::stated)};
  scale_places(bundle, 5);
  EXPECT_NEAR(scale_by_rigs(bundle), 0.2, 1e-9);
}

}  // namespace
}  // namespace axial::pose
