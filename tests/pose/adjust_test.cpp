// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/adjust/adjust.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "base/order_statistics.h"
#include "drawn.h"
#include "pose/adjust/depth_sigma.h"
#include "pose/adjust/uncertainty.h"
#include "pose/survey.h"
#include "support/error_of.h"

namespace axial::pose {
namespace {

using testing::camera_behind;
using testing::disturb;
using testing::dome_port;
using testing::flat_port;
using testing::housed;
using testing::kDegree;
using testing::known_length;
using testing::pose_errors;
using testing::survey;

struct Case {
  const char* name;
  refractive::Port<double> port;
};

std::ostream& operator<<(std::ostream& out, const Case& one) {
  return out << one.name;
}

class AdjustBehind : public ::testing::TestWithParam<Case> {};

TEST_P(AdjustBehind, FindsPosesPointsAndScaleOfPerfectTracks) {
  const Bundle truth = survey(camera_behind(GetParam().port), {});
  Bundle bundle = truth;
  disturb(bundle, 0.5 * kDegree, 0.01, 3);
  bundle.images[0].pose = truth.images[0].pose;
  AdjustOptions options;
  // A measured length gives the true scale: a centred dome does not determine it.
  options.distances.push_back(known_length(truth));
  const AdjustReport report = adjust(bundle, options);
  EXPECT_LT(report.final_cost, 1e-9 * report.initial_cost);
  const auto errors = pose_errors(bundle, truth, false);
  EXPECT_LT(errors.centre_rms, 1e-7);
  EXPECT_LT(errors.largest_angle, 1e-5);
}

// The expected sum of squares counts two residuals for each observation, minus one per unknown.
TEST_P(AdjustBehind, LeavesAsMuchErrorAsTheNoise) {
  const Bundle truth = survey(camera_behind(GetParam().port), {.noise = 0.5});
  Bundle bundle = truth;
  disturb(bundle, 0.2 * kDegree, 0.003, 3);
  AdjustOptions options;
  options.pixel_sigma = 0.5;
  options.loss_sigmas = 100;
  adjust(bundle, options);
  const double numbers = 2.0 * static_cast<double>(bundle.observations.size());
  const double unknowns = 6.0 * 11 + 3.0 * static_cast<double>(bundle.points.size());
  const double expected = 0.5 * std::sqrt(2 * (1 - unknowns / numbers));
  const double rms = root_mean_square(reprojection_errors(bundle));
  EXPECT_NEAR(rms, expected, 0.03 * expected);  // 1 / sqrt(2 x 5000) is 1 %
  EXPECT_NEAR(observed_pixel_sigma(bundle, options), 0.5, 0.015);
}

INSTANTIATE_TEST_SUITE_P(Ports, AdjustBehind,
                         ::testing::Values(Case{"FlatPort", flat_port(3)},
                                           Case{"FarPort", flat_port(0, 0.1)},
                                           Case{"Dome", dome_port()}),
                         [](const auto& tested) { return tested.param.name; });

// With known poses each point has three unknowns, and no other length must be known.
TEST(Adjust, PlacesPointsAmongKnownPoses) {
  const Bundle truth = survey(camera_behind(flat_port(3)), {.noise = 0.5});
  Bundle bundle = truth;
  for (BundlePoint& point : bundle.points) point.position += Eigen::Vector3d(0.01, -0.01, 0.02);
  AdjustOptions options;
  options.poses_known = true;
  options.pixel_sigma = 0.5;
  options.loss_sigmas = 100;
  adjust(bundle, options);
  for (std::size_t i = 0; i < bundle.images.size(); ++i) {
    EXPECT_EQ(bundle.images[i].pose.centre, truth.images[i].pose.centre);
    EXPECT_EQ(bundle.images[i].pose.rotation, truth.images[i].pose.rotation);
  }
  const double numbers = 2.0 * static_cast<double>(bundle.observations.size());
  const double unknowns = 3.0 * static_cast<double>(bundle.points.size());
  const double expected = 0.5 * std::sqrt(2 * (1 - unknowns / numbers));
  const double rms = root_mean_square(reprojection_errors(bundle));
  EXPECT_NEAR(rms, expected, 0.03 * expected);  // 1 / sqrt(2 x 5000) is 1 %
  const Uncertainty known = uncertainty(bundle, options);
  EXPECT_NEAR(known.pixel_sigma, 0.5, 0.015);
  EXPECT_EQ(known.scale_sigma, 0);
}

// Known poses determine the distance of the port, as a known scale does.
TEST(Adjust, KnownPosesTellTheDistanceOfThePort) {
  const Bundle truth = survey(camera_behind(flat_port()), {.noise = 0.3});
  Bundle bundle = truth;
  AdjustOptions options;
  options.poses_known = true;
  options.free[2] = true;
  bundle.cameras[0].change(2) = 0.005;
  adjust(bundle, options);
  const double sigma = uncertainty(bundle, options).camera_sigmas[0](2);
  EXPECT_LT(sigma, 0.001);  // a fifth of the initial error
  EXPECT_LT(std::abs(bundle.cameras[0].change(2)), 4 * sigma);
}

TEST(Adjust, OutliersHaveLittleSay) {
  const Bundle truth = survey(camera_behind(flat_port()), {.noise = 0.3});
  const auto error_with = [&](double loss_sigmas) {
    Bundle bundle = truth;
    for (std::size_t i = 0; i < bundle.observations.size(); i += 50)
      bundle.observations[i].pixel += Eigen::Vector2d(40, -30);
    AdjustOptions options;
    options.pixel_sigma = 0.3;
    options.loss_sigmas = loss_sigmas;
    adjust(bundle, options);
    return pose_errors(bundle, truth).centre_rms;
  };
  EXPECT_LT(error_with(2), 0.2 * error_with(1e9));
}

// Outliers move their points by short steps. Once the damping is small, an iteration that hardly
// changes the cost is the last.
TEST(Adjust, EndsWhenTheCostStaysTheSame) {
  Bundle bundle = survey(camera_behind(flat_port()), {.noise = 0.3});
  for (std::size_t i = 0; i < bundle.observations.size(); i += 7)
    bundle.observations[i].pixel += Eigen::Vector2d(i % 2 == 0 ? 3 : -4, i % 3 == 0 ? 2 : -3);
  AdjustOptions options;
  options.pixel_sigma = 0.3;
  options.free.fill(true);
  options.prior_sigma = {0.05, 0.05, 0.005, 0.004, 0.0005, 0.005};
  std::vector<double> costs;
  const AdjustReport report = adjust(
      bundle, options, [&](const AdjustIteration& iteration) { costs.push_back(iteration.cost); });
  EXPECT_TRUE(report.converged);
  int unchanged = 0;
  for (std::size_t i = 8; i < costs.size(); ++i)
    unchanged += costs[i - 1] - costs[i] < 1e-8 * costs[i] ? 1 : 0;
  EXPECT_LE(unchanged, 1);
}

// An image without observations, first or farthest, does not affect the scale's standard deviation.
TEST(Uncertainty, IsNotMistakenByAnImageWithoutObservations) {
  const Bundle whole = survey(camera_behind(flat_port()), {.noise = 0.5});
  for (const std::size_t lost : {std::size_t{0}, std::size_t{11}}) {
    Bundle bundle = whole;
    std::erase_if(bundle.observations, [&](const Observation& o) { return o.image == lost; });
    bundle.images[lost].pose.centre.x() += lost == 0 ? -100 : 100;
    AdjustOptions options;
    adjust(bundle, options);
    const double sigma = uncertainty(bundle, options).scale_sigma;
    EXPECT_GT(sigma, 0.8 * uncertainty(whole, options).scale_sigma);
    EXPECT_LT(sigma, 2 * uncertainty(whole, options).scale_sigma);
  }
}

TEST(Adjust, KnownPositionsHoldTheModel) {
  const Bundle truth = survey(camera_behind(flat_port()), {.noise = 0.3});
  Bundle bundle = truth;
  AdjustOptions options;
  for (const std::size_t image : {std::size_t{0}, std::size_t{4}, std::size_t{11}})
    options.positions.push_back({image,
                                 truth.images[image].pose.centre + Eigen::Vector3d(1, 2, 3) * 0.01,
                                 Eigen::Vector3d::Constant(1e-5)});
  adjust(bundle, options);
  for (const KnownPosition& known : options.positions)
    EXPECT_LT((bundle.images[known.image].pose.centre - known.metres).norm(), 1e-4);
  EXPECT_LT(pose_errors(bundle, truth).centre_rms, 0.001);
}

TEST(Adjust, AWrongPositionDoesNotBendTheModel) {
  const Bundle truth = survey(camera_behind(flat_port()), {.noise = 0.3});
  const auto centre_error = [&](double off) {
    Bundle bundle = truth;
    AdjustOptions options;
    for (std::size_t i = 0; i < truth.images.size(); ++i)
      options.positions.push_back(
          {i, truth.images[i].pose.centre, Eigen::Vector3d::Constant(1e-3)});
    options.positions[5].metres.x() += off;
    adjust(bundle, options);
    return pose_errors(bundle, truth).centre_rms;
  };
  EXPECT_LT(centre_error(0.1), 2 * centre_error(0));  // 30 times without a robust loss
}

TEST(Adjust, AKnownLengthBetweenPointsSetsTheScale) {
  const Bundle truth = survey(camera_behind(std::nullopt), {});
  Bundle bundle = truth;
  AdjustOptions options;
  const double length = (truth.points[0].position - truth.points[7].position).norm();
  options.distances.push_back({KnownDistance::Between::points, 0, 7, 2 * length, 1e-4});
  adjust(bundle, options);
  EXPECT_NEAR(pose_errors(bundle, truth).scale, 0.5, 1e-6);
}

TEST(Adjust, RefusesWhatCannotBe) {
  const Bundle truth = survey(camera_behind(std::nullopt), {});
  Bundle bundle = truth;
  AdjustOptions options;
  options.free[2] = true;
  EXPECT_NE(test::error_of([&] { adjust(bundle, options); }).find("no port"), std::string::npos);
  options = {};
  options.distances.push_back({KnownDistance::Between::images, 0, 1, -1, 0.1});
  EXPECT_NE(test::error_of([&] { adjust(bundle, options); }).find("-1"), std::string::npos);
  bundle.observations.clear();
  EXPECT_NE(test::error_of([&] { adjust(bundle, {}); }).find("no observations"), std::string::npos);
}

// In air nothing determines the scale; behind a port, a more distant port determines it better.
TEST(Uncertainty, OfTheScaleIsWhatThePortMakesIt) {
  const auto scale_sigma = [](std::optional<refractive::Port<double>> port) {
    const Bundle bundle = survey(camera_behind(std::move(port)), {.noise = 0.5});
    return uncertainty(bundle, {}).scale_sigma;
  };
  const double near = scale_sigma(flat_port(0, 0.005)), far = scale_sigma(flat_port(0, 0.1));
  EXPECT_TRUE(std::isinf(scale_sigma(std::nullopt)));
  EXPECT_LT(far, 0.3 * near);
  EXPECT_LT(far, 0.1);
  EXPECT_GT(far, 0);
}

TEST(Uncertainty, OfAKnownLengthIsThatOfTheMeasure) {
  const Bundle bundle = survey(camera_behind(std::nullopt), {.noise = 0.5});
  AdjustOptions options;
  options.distances.push_back(known_length(bundle, 0.02));
  EXPECT_NEAR(uncertainty(bundle, options).scale_sigma, 0.02, 1e-4);
}

Bundle with_noise(Bundle bundle, double sigma, int seed) {
  std::mt19937_64 random(static_cast<unsigned>(seed) + 100);
  std::normal_distribution<double> noise(0, sigma);
  for (Observation& observation : bundle.observations)
    observation.pixel += axial::test::drawn<2>(noise, random);
  return bundle;
}

// If port and scene are both farther away by the same factor, photographs are the same except for
// the glass. One length must be known to find the port's distance.
KnownDistance known_baseline(const Bundle& truth) {
  KnownDistance known = known_length(truth);
  known.sigma = 1e-5;
  return known;
}

// Results of many surveys that differ in noise alone: the scatter of the port's numbers about the
// truth, and their predicted standard deviations. Sums of squares over the runs.
struct Scatter {
  HousingChange<double> sum2 = HousingChange<double>::Zero(), predicted2 = sum2;
};

Scatter scatter_of_port(int runs, double loss_sigmas) {
  const Bundle exact = survey(camera_behind(flat_port(2, 0.02)), {.images = 8, .points = 150});
  AdjustOptions options;
  options.free = {true, true, true, false, false};
  options.pixel_sigma = 0.5;
  options.loss_sigmas = loss_sigmas;
  options.distances.push_back(known_baseline(exact));
  Scatter scatter;
  for (int run = 0; run < runs; ++run) {
    Bundle bundle = with_noise(exact, 0.5, run);
    adjust(bundle, options);
    const Uncertainty found = uncertainty(bundle, options);
    scatter.sum2 += bundle.cameras[0].change.cwiseAbs2();
    scatter.predicted2 += found.camera_sigmas[0].cwiseAbs2();
  }
  return scatter;
}

TEST(Uncertainty, OfThePortIsHonest) {
  const Scatter scatter = scatter_of_port(30, 100);
  // The ratio of a sum of 30 squares to its expectation scatters by sqrt(2/30) = 26 %; three times
  // this is allowed.
  for (int k = 0; k < 3; ++k) {
    EXPECT_GT(scatter.sum2(k) / scatter.predicted2(k), 0.3) << k;
    EXPECT_LT(scatter.sum2(k) / scatter.predicted2(k), 1.9) << k;
  }
  for (int k = 3; k < kHousingNumbers; ++k)
    EXPECT_EQ(scatter.sum2(k) + scatter.predicted2(k), 0) << k;
}

// Compares the default loss (Huber's, from 2 sigma on) with no loss on the same surveys. The two
// results differ by the loss alone, so five surveys suffice. With Gaussian noise the loss costs 1.8
// % of efficiency (a seventh of the errors are beyond 2 sigma), and variances grow by 1.8 %. The
// remaining ratio of the sums scatters by 2 sqrt(0.018/5) = 12 %; three times this scatter is
// allowed. The weights have a mean of 0.98, so predicted variances grow by up to 2.2 %, and less
// where residuals of a fit are smaller than the noise.
TEST(Uncertainty, OfThePortIsHonestWithTheDefaultLoss) {
  const Scatter robust = scatter_of_port(5, AdjustOptions().loss_sigmas);
  const Scatter none = scatter_of_port(5, 100);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(robust.sum2(k) / none.sum2(k), 1.018, 0.36) << k;
    EXPECT_GT(robust.predicted2(k) / none.predicted2(k), 1.005) << k;  // the loss has an effect
    EXPECT_LT(robust.predicted2(k) / none.predicted2(k), 1.022) << k;
  }
}

TEST(Uncertainty, OfScaleAndShapeIsHonest) {
  constexpr int kRuns = 30;
  const Bundle exact = survey(camera_behind(flat_port(0, 0.1)), {.images = 8, .points = 150});
  double sum2 = 0, predicted2 = 0, shape2 = 0, predicted_shape2 = 0;
  for (int run = 0; run < kRuns; ++run) {
    Bundle bundle = with_noise(exact, 0.5, run);
    AdjustOptions options;
    options.pixel_sigma = 0.5;
    options.loss_sigmas = 100;
    adjust(bundle, options);
    const testing::PoseErrors errors = pose_errors(bundle, exact);
    sum2 += std::pow(1 / errors.scale - 1, 2);
    shape2 += std::pow(errors.centre_rms, 2);
    const Uncertainty known = uncertainty(bundle, options);
    predicted2 += std::pow(known.scale_sigma, 2);
    predicted_shape2 += std::pow(known.shape_sigma * median_distance(bundle), 2);
  }
  EXPECT_GT(sum2 / predicted2, 0.3);  // the same limits as for the port
  EXPECT_LT(sum2 / predicted2, 1.9);
  // A shape has at least four independent errors: the ratio scatters by sqrt(2 / 120) = 13 %.
  EXPECT_NEAR(shape2 / predicted_shape2, 1, 0.39);
}

// The median change of the distances of the points, if the camera centres have their true places.
double error_of_depths(const Bundle& found, const Bundle& truth) {
  const double scale = pose_errors(found, truth).scale;
  std::vector<double> ratios;
  for (const Observation& seen : truth.observations) {
    const auto distance = [&](const Bundle& bundle) {
      return (bundle.points[seen.point].position - bundle.images[seen.image].pose.centre).norm();
    };
    ratios.push_back(distance(found) / scale / distance(truth));
  }
  return upper_median(std::move(ratios)) - 1;
}

// Focal length and index are known as by a ruler. In each run they are stated with other errors.
// The noise alone moves the points, too, so the result is compared with that of the right numbers.
TEST(Uncertainty, OfDepthsIsHonest) {
  constexpr int kRuns = 40;
  constexpr double kFocal = 0.005, kIndex = 0.004;
  const Bundle exact = survey(camera_behind(flat_port(0, 0.05)), {.images = 6, .points = 120});
  AdjustOptions options;
  options.pixel_sigma = 0.5;
  options.loss_sigmas = 100;
  options.distances.push_back(known_length(exact));
  const AdjustOptions with_right_numbers = options;
  options.free[kIndexNumber] = options.free[kFocalNumber] = true;
  options.prior_sigma[kIndexNumber] = kIndex;
  options.prior_sigma[kFocalNumber] = kFocal;
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  double sum2 = 0, predicted2 = 0;
  for (int run = 0; run < kRuns; ++run) {
    refractive::FlatPort<double> port = flat_port(0, 0.05);
    port.n_water += kIndex * normal(random);
    CameraModel stated = camera_behind(port);
    const double factor = 1 + kFocal * normal(random);
    stated.lens.fx *= factor;
    stated.lens.fy *= factor;
    Bundle bundle = with_noise(exact, 0.5, run);
    bundle.cameras[0].measured = housed(stated);
    adjust(bundle, options);
    Bundle right = with_noise(exact, 0.5, run);
    adjust(right, with_right_numbers);
    sum2 += std::pow(error_of_depths(bundle, right), 2);
    predicted2 += std::pow(depth_sigma(bundle, options), 2);
  }
  EXPECT_GT(predicted2, kRuns * std::pow(5e-4, 2)) << "the numbers hardly matter";
  EXPECT_GT(sum2 / predicted2, 0.3);  // the same limits as for the port
  EXPECT_LT(sum2 / predicted2, 1.9);
}

TEST(Uncertainty, OfDepthsIsZeroIfAllNumbersAreFixed) {
  const Bundle bundle = survey(camera_behind(flat_port()), {.images = 4, .points = 60});
  EXPECT_EQ(depth_sigma(bundle, {}), 0);
}

TEST(Uncertainty, OfTheShapeDoesNotDependOnTheScale) {
  const Bundle bundle = survey(camera_behind(std::nullopt), {.noise = 0.5});
  AdjustOptions options;
  const double without = uncertainty(bundle, options).shape_sigma;
  options.distances.push_back(known_length(bundle, 0.02));
  const double with = uncertainty(bundle, options).shape_sigma;
  EXPECT_NEAR(without, with, 1e-3 * with);
  EXPECT_GT(with, 0);
}

// The two halves of a survey, with all common points or with four of them. Images of the same half
// have as many common points in both cases. A sum over n points has an error of 1 / sqrt(n): four
// points in place of the dozens that two halves share make it at least three times as large.
TEST(Uncertainty, OfTheShapeIsLargeWhereFewPointsLinkTheImages) {
  const Bundle whole = survey(camera_behind(flat_port()), {.images = 8, .noise = 0.5});
  Bundle weak = whole;
  for (BundlePoint point : whole.points) weak.points.push_back(point);
  for (Observation& observation : weak.observations)
    if (observation.image >= 4 && observation.point >= 4) observation.point += whole.points.size();
  AdjustOptions options;
  options.distances.push_back(known_length(whole));
  const double sigma = uncertainty(whole, options).shape_sigma;
  EXPECT_GT(uncertainty(weak, options).shape_sigma, 3 * sigma);
}

// Starts from a distance with an error of 5 mm and a tilt with an error of 1 degree.
TEST(Adjust, FindsThePortAgain) {
  const Bundle truth = survey(camera_behind(flat_port(2, 0.02)), {.points = 600, .noise = 0.5});
  Bundle bundle = truth;
  bundle.cameras[0].measured = housed(camera_behind(flat_port(3, 0.025)));
  AdjustOptions options;
  options.distances.push_back(known_baseline(truth));
  options.free = {true, true, true, false, false};
  options.pixel_sigma = 0.5;
  adjust(bundle, options);
  const Uncertainty found = uncertainty(bundle, options);
  const auto port = std::get<refractive::FlatPort<double>>(*bundle.cameras[0].now().port);
  const auto& sigmas = found.camera_sigmas[0];
  EXPECT_LT(std::abs(port.distance - 0.02), 3 * sigmas(2));
  EXPECT_LT(std::abs(std::asin(port.normal.x()) - 2 * kDegree), 3 * sigmas(0));
  EXPECT_LT(std::abs(std::asin(port.normal.y())), 3 * sigmas(1));
  EXPECT_LT(sigmas(0), 0.3 * kDegree);
  EXPECT_LT(sigmas(2), 0.004);
}

TEST(Adjust, FindsTheCentreOfADome) {
  const auto port = dome_port();
  const Bundle truth = survey(camera_behind(port), {.points = 600, .noise = 0.3});
  Bundle bundle = truth;
  auto wrong = port;
  wrong.centre += Eigen::Vector3d(0.002, -0.001, 0.002);
  bundle.cameras[0].measured = housed(camera_behind(wrong));
  AdjustOptions options;
  options.distances.push_back(known_baseline(truth));
  options.free = {true, true, true, false, false};
  options.pixel_sigma = 0.3;
  adjust(bundle, options);
  const Uncertainty found = uncertainty(bundle, options);
  const auto now = std::get<refractive::DomePort<double>>(*bundle.cameras[0].now().port);
  for (int k = 0; k < 3; ++k)
    EXPECT_LT(std::abs(now.centre(k) - port.centre(k)), 3 * found.camera_sigmas[0](k)) << k;
}

// Both paths must find the one minimum. The second ends when an iteration lowers half the cost by
// less than 1e-4. Huber's loss makes the solver converge linearly, by a factor of at least two in
// the last iterations, so less than 2e-4 is left: sqrt(2 x 2e-4) = 0.02 standard deviations.
TEST(Adjust, FindsTheSameMinimumOfManyImages) {
  const Bundle truth = survey(camera_behind(flat_port(3)), {.noise = 0.5});
  AdjustOptions options;
  options.pixel_sigma = 0.5;
  Bundle few = truth, many = truth;
  disturb(few, 0.5 * kDegree, 0.01, 3);
  disturb(many, 0.5 * kDegree, 0.01, 3);
  options.gain_of_outliers = 0;
  const AdjustReport usual = adjust(few, options);
  const double sigma = uncertainty(few, options).scale_sigma;
  options.many_images = 0;
  const AdjustReport report = adjust(many, options);
  EXPECT_TRUE(report.converged);
  EXPECT_LT(report.iterations, usual.iterations);
  EXPECT_NEAR(report.final_cost, usual.final_cost, 2e-4);
  EXPECT_NEAR(pose_errors(many, few).scale, 1, 0.02 * sigma);
  EXPECT_LT(pose_errors(many, few).centre_rms, 0.02 * pose_errors(few, truth).centre_rms);
}

// Points with wrong observations alone must not take all iterations, and the cameras are the same
// up to a small part of their errors.
TEST(Adjust, EndsWhereOnlyOutliersMove) {
  const Bundle truth = survey(camera_behind(flat_port(3)), {.noise = 0.5});
  Bundle early = truth;
  std::mt19937 draw(5);
  std::uniform_real_distribution<double> wrong(-60, 60);
  for (Observation& observation : early.observations)
    if (observation.point % 8 == 0) observation.pixel += axial::test::drawn<2>(wrong, draw);
  disturb(early, 0.5 * kDegree, 0.01, 3);
  Bundle late = early;
  AdjustOptions options;
  options.pixel_sigma = 0.5;
  const AdjustReport ends_early = adjust(early, options);
  options.gain_of_outliers = 0;
  const AdjustReport ends_late = adjust(late, options);
  EXPECT_TRUE(ends_early.converged);
  EXPECT_LT(ends_early.iterations, ends_late.iterations);
  EXPECT_NEAR(ends_early.final_cost, ends_late.final_cost,
              0.01 * (ends_late.iterations - ends_early.iterations));
  EXPECT_LT(pose_errors(early, late).centre_rms, 0.05 * pose_errors(late, truth).centre_rms);
}

TEST(Adjust, ReportsEveryIteration) {
  Bundle bundle = survey(camera_behind(flat_port(3)), {.images = 6, .points = 60, .noise = 0.5});
  disturb(bundle, 0.5 * kDegree, 0.01, 3);
  std::vector<AdjustIteration> said;
  const AdjustReport report =
      adjust(bundle, {}, [&](const AdjustIteration& iteration) { said.push_back(iteration); });
  ASSERT_GT(said.size(), 2u);
  for (std::size_t i = 0; i < said.size(); ++i) EXPECT_EQ(said[i].number, static_cast<int>(i));
  EXPECT_EQ(said.front().cost, report.initial_cost);
  EXPECT_NEAR(said.back().cost, report.final_cost, 1e-9 * report.final_cost);
}

// One pixel is moved by 7 px, far more than the noise: its error is the last of its image.
TEST(ReprojectionErrors, ByImageAreInTheOrderOfTheObservations) {
  constexpr std::size_t kMoved = 5, kUnseen = 3;
  Bundle bundle = survey(camera_behind(flat_port()), {.images = 6, .points = 40, .noise = 0.1});
  std::erase_if(bundle.observations, [](const Observation& o) { return o.image == kUnseen; });
  const auto is_moved = [](const Observation& o) { return o.image == kMoved; };
  const auto last =
      std::find_if(bundle.observations.rbegin(), bundle.observations.rend(), is_moved);
  ASSERT_NE(last, bundle.observations.rend());
  last->pixel.x() += 7;
  const std::vector<std::vector<double>> errors = reprojection_errors_by_image(bundle);
  ASSERT_EQ(errors.size(), bundle.images.size());
  EXPECT_TRUE(errors[kUnseen].empty());
  for (std::size_t i = 0; i < errors.size(); ++i) {
    EXPECT_EQ(errors[i].size(), observations_by_image(bundle)[i]) << i;
    for (std::size_t k = 0; k < errors[i].size(); ++k)
      EXPECT_EQ(errors[i][k] > 3, i == kMoved && k + 1 == errors[i].size()) << i << " " << k;
  }
}

}  // namespace
}  // namespace axial::pose
