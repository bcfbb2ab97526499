// SPDX-License-Identifier: GPL-3.0-or-later
// Turns the poses of a pinhole engine for underwater photographs into refractive poses.
#include "pose/refine.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <random>
#include <stop_token>

#include "drawn.h"
#include "pose/adjust/uncertainty.h"
#include "pose/survey.h"

namespace axial::pose {
namespace {

using testing::absorbed;
using testing::camera_behind;
using testing::dome_port;
using testing::flat_port;
using testing::known_length;
using testing::mixed_survey;
using testing::pose_errors;
using testing::survey;
using testing::SurveyOptions;

struct Case {
  const char* name;
  refractive::Port<double> port;
  double distance;          // of the scene [m]
  bool tells_scale = true;  // to 50 %; a dome centred at the camera does not determine it
};

std::ostream& operator<<(std::ostream& out, const Case& one) {
  return out << one.name;
}

// The known length between the survey's ends determines the scale.
RefineOptions with_known_length(const Bundle& truth) {
  RefineOptions options;
  options.adjust.distances.push_back(known_length(truth));
  return options;
}

class RefineBehind : public ::testing::TestWithParam<Case> {};

TEST_P(RefineBehind, FindsPosesFromAbsorbedOnes) {
  const Bundle truth = survey(camera_behind(GetParam().port),
                              {.distance = GetParam().distance, .points = 400, .noise = 0.2});
  Bundle bundle = absorbed(truth, 7.3);
  const RefineOptions options = with_known_length(truth);
  bring_to_metres(bundle, options.adjust);
  const RefineReport report = refine(bundle, options);
  EXPECT_LT(report.rms_after, 0.2 * std::sqrt(2.0) * 1.02);
  EXPECT_GT(report.rms_after, 0.2 * std::sqrt(2.0) * 0.8);
  const auto errors = pose_errors(bundle, truth);
  EXPECT_LT(errors.centre_rms, 0.001 * GetParam().distance);
  EXPECT_LT(errors.largest_angle, 0.05);
  EXPECT_NEAR(errors.scale, 1, 1e-3);
  EXPECT_GT(report.observations_after, report.observations_before * 98 / 100);
}

// With true tracks the remaining error is the noise, minus one residual for each unknown: six of
// each image but the first (which fixes the frame), and three of each point; the known length
// determines the scale. The tolerance is 10 %; the noise of so many residuals scatters by 1 %.
TEST_P(RefineBehind, LeavesTheErrorsThatTheNoiseMakes) {
  constexpr double kNoise = 0.5;
  const Bundle truth = survey(camera_behind(GetParam().port),
                              {.distance = GetParam().distance, .points = 400, .noise = kNoise});
  Bundle bundle = absorbed(truth, 7.3);
  const RefineOptions options = with_known_length(truth);
  bring_to_metres(bundle, options.adjust);
  const RefineReport report = refine(bundle, options);
  const double residuals = 2.0 * static_cast<double>(bundle.observations.size());
  const double unknowns = 6.0 * static_cast<double>(bundle.images.size() - 1) +
                          3.0 * static_cast<double>(bundle.points.size());
  const double expected = kNoise * std::sqrt(2.0) * std::sqrt(1 - unknowns / residuals);
  EXPECT_NEAR(report.rms_after, expected, 0.1 * expected);
  EXPECT_GT(report.observations_after, report.observations_before * 98 / 100);
}

// From refraction alone, the scale is right within its standard deviation.
TEST_P(RefineBehind, SaysHowWellItKnowsTheScale) {
  const Bundle truth = survey(camera_behind(GetParam().port),
                              {.distance = GetParam().distance, .points = 400, .noise = 0.2});
  Bundle bundle = absorbed(truth, 7.3);
  RefineOptions options;
  bring_to_metres(bundle, options.adjust);
  const RefineReport report = refine(bundle, options);
  const double scale = 1 / pose_errors(bundle, truth).scale;
  const double sigma = uncertainty(bundle, options.adjust).scale_sigma;
  EXPECT_LT(std::abs(std::log(scale)), 3 * sigma);
  EXPECT_EQ(sigma < 0.5, GetParam().tells_scale);
  EXPECT_LT(report.rms_after, 0.2 * std::sqrt(2.0) * 1.02);
}

INSTANTIATE_TEST_SUITE_P(Ports, RefineBehind,
                         ::testing::Values(Case{"Flat", flat_port(0), 2.5},
                                           Case{"CloseUp", flat_port(0), 0.7},
                                           Case{"Tilted", flat_port(3), 2.5},
                                           Case{"FarPort", flat_port(0, 0.1), 2.5},
                                           Case{"Dome", dome_port(), 2.5, false}),
                         [](const auto& tested) { return tested.param.name; });

// Half of the images are taken behind a flat port, the others behind a dome, each with its own
// camera.
TEST(RefineBehindFlatPortsAndDomes, FindsPosesFromAbsorbedOnes) {
  const Bundle truth = mixed_survey(camera_behind(flat_port(3)), camera_behind(dome_port()),
                                    {.distance = 0.8, .points = 400, .noise = 0.2});
  const RefineOptions options = with_known_length(truth);
  const auto refined = [&](bool swapped) {
    Bundle bundle = absorbed(truth, 7.3);
    for (BundleImage& image : bundle.images)
      if (swapped) image.camera = 1 - image.camera;
    bring_to_metres(bundle, options.adjust);
    const RefineReport report = refine(bundle, options);
    return std::pair(bundle, report);
  };
  const auto [bundle, report] = refined(false);
  EXPECT_LT(report.rms_after, 0.2 * std::sqrt(2.0) * 1.02);
  EXPECT_GT(report.rms_after, 0.2 * std::sqrt(2.0) * 0.8);
  EXPECT_GT(report.observations_after, report.observations_before * 98 / 100);
  const auto before = pose_errors(absorbed(truth, 7.3), truth), after = pose_errors(bundle, truth);
  EXPECT_LT(after.centre_rms, 0.001 * 0.8);
  EXPECT_LT(after.largest_angle, 0.05);
  EXPECT_NEAR(after.scale, 1, 1e-3);
  EXPECT_GT(before.centre_rms, 5 * after.centre_rms);
  EXPECT_GT(pose_errors(refined(true).first, truth).centre_rms, 5 * after.centre_rms);
}

// Positions of unknown accuracy, with the standard deviation `sigma` in truth.
AdjustOptions with_positions(const Bundle& truth, double sigma, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0, sigma);
  AdjustOptions options;
  for (std::size_t i = 0; i < truth.images.size(); ++i) {
    const Eigen::Vector3d off = axial::test::drawn<3>(noise, random);
    options.positions.push_back(
        {i, truth.images[i].pose.centre + off, Eigen::Vector3d::Constant(0.1), true});
  }
  return options;
}

// A survey as COLMAP finds it, with positions.
class RefineWithPositions : public ::testing::Test {
 protected:
  const Bundle truth_ =
      survey(camera_behind(flat_port(3)), {.distance = 2.5, .points = 400, .noise = 0.3});
  const Bundle absorbed_ = absorbed(truth_, 7.3);

  std::pair<Bundle, RefineReport> refined(const RefineOptions& options) const {
    Bundle bundle = absorbed_;
    bring_to_metres(bundle, options.adjust);
    const RefineReport report = refine(bundle, options);
    return {bundle, report};
  }
};

// The standard deviation of positions is estimated, so that they do not bend the poses, and so that
// lengths are known as well as the report says.
TEST_F(RefineWithPositions, EstimatesTheirAccuracy) {
  const double exact = pose_errors(refined(with_known_length(truth_)).first, truth_).centre_rms;
  for (const double sigma : {0.005, 0.05}) {
    RefineOptions options;
    options.adjust = with_positions(truth_, sigma, 7);
    const auto [bundle, report] = refined(options);
    ASSERT_EQ(report.positions.size(), 12u);
    EXPECT_NEAR(report.positions[0].sigma.x(), sigma, 0.4 * sigma);
    EXPECT_LT(pose_errors(bundle, truth_).centre_rms, 1.1 * exact);
    options.adjust.positions = report.positions;
    const double stated = uncertainty(bundle, options.adjust).scale_sigma;
    EXPECT_LT(std::abs(pose_errors(bundle, truth_).scale - 1), 3 * stated);
    EXPECT_GT(stated, 0.2 * sigma);
    EXPECT_LT(stated, sigma);
  }
}

// Poses from few, coarse observations are about as uncertain as the positions. They must not follow
// the positions so far that the positions seem exact.
TEST(Refine, EstimatesTheAccuracyOfPositionsBesideUncertainPoses) {
  constexpr double kSigma = 0.004;
  constexpr int kDraws = 10;
  double variance = 0;
  for (unsigned draw = 0; draw < kDraws; ++draw) {
    const Bundle truth =
        survey(camera_behind(flat_port()),
               {.distance = 2.5, .images = 8, .points = 60, .noise = 1.5, .seed = 1 + draw});
    RefineOptions options;
    options.tracks.max_error = 10;
    options.adjust = with_positions(truth, kSigma, draw);
    Bundle bundle = truth;
    const double sigma = refine(bundle, options).positions[0].sigma.x();
    variance += sigma * sigma / kDraws;
  }
  EXPECT_GT(std::sqrt(variance), 0.8 * kSigma);
}

// The initial poses are bent, so a wrong position is found only by refined poses.
TEST_F(RefineWithPositions, FindsAWrongOneByTheRefinedPoses) {
  RefineOptions options;
  options.adjust = with_positions(truth_, 0.002, 7);
  options.adjust.positions[4].metres.x() += 0.1;
  Bundle start = absorbed_;
  bring_to_metres(start, options.adjust);
  std::vector<KnownPosition> of_start = options.adjust.positions;
  ASSERT_TRUE(judge_positions(start, 1, of_start).empty());
  const auto [bundle, report] = refined(options);
  ASSERT_EQ(report.wrong_positions.size(), 1u);
  EXPECT_NE(report.wrong_positions[0].find("image4.jpg"), std::string::npos);
  EXPECT_EQ(report.positions.size(), 11u);
  EXPECT_LT(report.positions[0].sigma.x(), 0.004);
}

// Positions that contradict their standard deviation are corrected for the standard deviation of
// lengths, and do not bend the poses.
TEST_F(RefineWithPositions, CorrectsAContradictedStandardDeviation) {
  const double exact = pose_errors(refined(with_known_length(truth_)).first, truth_).centre_rms;
  RefineOptions options;
  options.adjust = with_positions(truth_, 0.05, 7);
  for (KnownPosition& known : options.adjust.positions) {
    known.sigma.setConstant(0.001);
    known.sigma_is_guess = false;
  }
  const auto [bundle, report] = refined(options);
  EXPECT_GT(report.position_distances.of_stated, 10);
  EXPECT_GT(report.positions[0].sigma.x(), 0.02);
  EXPECT_LT(pose_errors(bundle, truth_).centre_rms, 3 * exact);
  options.adjust.positions = report.positions;
  const double stated = uncertainty(bundle, options.adjust).scale_sigma;
  EXPECT_LT(std::abs(pose_errors(bundle, truth_).scale - 1), 3 * stated);
}

TEST(BringToMetres, TakesTheScaleOfKnownPositions) {
  const Bundle truth = survey(camera_behind(flat_port()), {});
  Bundle bundle = truth;
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  for (BundleImage& image : bundle.images) {
    image.pose.centre = 3 * (turn * image.pose.centre) + Eigen::Vector3d(1, 2, 3);
    image.pose.rotation = image.pose.rotation * turn.transpose();
  }
  AdjustOptions options;
  for (const std::size_t image : {std::size_t{0}, std::size_t{4}, std::size_t{11}})
    options.positions.push_back(
        {image, truth.images[image].pose.centre, Eigen::Vector3d::Constant(0.001)});
  bring_to_metres(bundle, options);
  for (std::size_t i = 0; i < truth.images.size(); ++i) {
    EXPECT_LT((bundle.images[i].pose.centre - truth.images[i].pose.centre).norm(), 1e-9);
    EXPECT_LT((bundle.images[i].pose.rotation - truth.images[i].pose.rotation).norm(), 1e-9);
  }
  for (const double error : reprojection_errors(bundle)) ASSERT_LT(error, 1e-6);
}

// The rounds of many images end early, which must not change what is dropped or found. Half the
// cost of the last adjustment ends within 2e-4 of the minimum (adjust_test): 0.02 standard
// deviations.
TEST(Refine, DropsAndFindsTheSameInManyImages) {
  const Bundle truth =
      survey(camera_behind(flat_port(3)), {.distance = 2.5, .points = 400, .noise = 0.3});
  Bundle start = absorbed(truth, 7.3);
  for (std::size_t i = 0; i < start.observations.size(); i += 25)
    start.observations[i].pixel += Eigen::Vector2d(30, 20);
  RefineOptions options = with_known_length(truth);
  bring_to_metres(start, options.adjust);
  Bundle few = start, many = start;
  const RefineReport usual = refine(few, options);
  options.adjust.many_images = 0;
  const RefineReport report = refine(many, options);
  EXPECT_TRUE(report.last.converged);
  EXPECT_EQ(report.observations_after, usual.observations_after);
  EXPECT_NEAR(report.rms_after, usual.rms_after, 1e-5);
  EXPECT_LT(pose_errors(many, few).centre_rms, 0.02 * pose_errors(few, truth).centre_rms);
}

TEST(Refine, TellsTheIterationsOfEachRound) {
  Bundle bundle = survey(camera_behind(flat_port()), {.noise = 0.3});
  std::vector<std::string> rounds, iterations;
  const Context context([&](const Event& event) {
    (event.level == LogLevel::trace ? iterations : rounds).push_back(event.text);
  });
  refine(bundle, {}, context);
  EXPECT_EQ(rounds.size(), 3u);
  for (const char* start : {"round 1: iteration 0, cost ", "round 1: iteration 1, cost ",
                            "round 3: iteration 0, cost ", "last adjustment: iteration 0, cost "})
    EXPECT_EQ(std::ranges::count_if(
                  iterations, [&](const std::string& line) { return line.starts_with(start); }),
              1)
        << start;
}

TEST(Refine, StopsInAnAdjustment) {
  Bundle bundle = survey(camera_behind(flat_port()), {.noise = 0.3});
  std::stop_source source;
  std::size_t lines = 0;
  const Context context(
      [&](const Event&) {
        if (++lines == 3) source.request_stop();
      },
      source.get_token());
  EXPECT_THROW(refine(bundle, {}, context), Stopped);
  EXPECT_EQ(lines, 3u);
}

TEST(Refine, TellsTheStartOfEachAdjustmentOfManyImages) {
  const Bundle start = survey(camera_behind(flat_port()), {.noise = 0.3});
  for (const std::size_t many : {start.images.size(), start.images.size() + 1}) {
    Bundle bundle = start;
    RefineOptions options;
    options.adjust.many_images = many;
    std::vector<std::string> lines;
    const Context context([&](const Event& event) { lines.push_back(event.text); });
    refine(bundle, options, context);
    for (const char* begin : {"round 1: starts with ", "round 2: starts with ",
                              "round 3: starts with ", "last adjustment: starts with "})
      EXPECT_EQ(std::ranges::count_if(
                    lines, [&](const std::string& line) { return line.starts_with(begin); }),
                many == start.images.size() ? 1 : 0)
          << begin;
  }
}

TEST(Refine, DropsOutliers) {
  const Bundle truth = survey(camera_behind(flat_port()), {.points = 600, .noise = 0.3});
  Bundle bundle = truth;
  std::size_t outliers = 0;
  for (std::size_t i = 0; i < bundle.observations.size(); i += 25, ++outliers)
    bundle.observations[i].pixel += Eigen::Vector2d(30, 20);
  const RefineReport report = refine(bundle, {});
  EXPECT_GE(report.observations_before - report.observations_after, outliers);
  EXPECT_LE(report.observations_before - report.observations_after, outliers + outliers / 5);
  EXPECT_LT(report.rms_after, 0.3 * std::sqrt(2.0) * 1.02);
}

}  // namespace
}  // namespace axial::pose
