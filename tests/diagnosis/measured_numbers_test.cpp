// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers of lens and port that were measured with a ruler: they are estimated near their measured
// values.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "base/order_statistics.h"
#include "diagnosis/refined_check.h"
#include "diagnosis/words.h"
#include "drawn.h"
#include "pose/adjust/adjust.h"
#include "pose/adjust/free_numbers.h"
#include "pose/adjust/uncertainty.h"
#include "pose/refine.h"
#include "pose/survey.h"
#include "scene/decompositions.h"
#include "support/error_of.h"

namespace axial::pose {
namespace {

using testing::camera_behind;
using testing::dome_port;
using testing::flat_port;
using ::testing::HasSubstr;
using testing::kDegree;
using testing::survey;

using Flat = refractive::FlatPort<double>;
using Dome = refractive::DomePort<double>;

constexpr double kNoise = 0.3;  // [px]

Bundle true_survey(const refractive::Port<double>& port, double distance, unsigned seed = 1,
                   int points = 400) {
  return survey(camera_behind(port),
                {.distance = distance, .points = points, .noise = kNoise, .seed = seed});
}

// The errors of a diver's measurements.
struct Errors {
  double tilt_degrees = 0, distance = 0, index = 0, focal = 0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();

  int count() const {
    int wrong = 0;
    for (const double error :
         {tilt_degrees, distance, index, focal, centre.x(), centre.y(), centre.z()})
      wrong += error != 0 ? 1 : 0;
    return wrong;
  }
};

// The survey as a pinhole engine reconstructs it, with measured numbers that are wrong by `errors`.
Bundle brought(const Bundle& truth, const Errors& errors) {
  Bundle bundle = testing::absorbed(truth, 7.3);
  HousingChange<double> change = HousingChange<double>::Zero();
  const auto& port = *truth.cameras[0].measured.port;
  if (std::holds_alternative<Dome>(port))
    change.head<3>() = errors.centre;
  else
    change.head<3>() << errors.tilt_degrees * kDegree, 0, errors.distance;
  change(kIndexNumber) = errors.index;
  change(kFocalNumber) = errors.focal;
  bundle.cameras[0].measured = with_change(truth.cameras[0].measured, change);
  return bundle;
}

RefineOptions options_for(const Bundle& truth, const Bundle& brought, const std::string& refine,
                          bool with_length) {
  RefineOptions options;
  if (with_length) options.adjust.distances.push_back(testing::known_length(truth));
  set_estimated_numbers(refine, {}, brought, options.adjust);
  return options;
}

struct Refined {
  Bundle bundle;
  RefineOptions options;
  RefineReport report;
};

// `keep`: numbers that the tracks do not contradict keep their stated values, as in RefinePoses.
Refined refined(const Bundle& truth, const Errors& errors, const std::string& refine,
                bool with_length = true, bool keep = true) {
  Refined result{brought(truth, errors), {}, {}};
  result.options = options_for(truth, result.bundle, refine, with_length);
  result.options.keep_stated = keep && refine == "auto";
  bring_to_metres(result.bundle, result.options.adjust);
  result.report = pose::refine(result.bundle, result.options);
  return result;
}

// The median distance of the points from their true places, placed by the camera centres [m].
double point_error(const Bundle& found, const Bundle& truth) {
  const auto count = static_cast<Eigen::Index>(found.images.size());
  Eigen::Matrix3Xd from(3, count), to(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    from.col(i) = found.images[static_cast<std::size_t>(i)].pose.centre;
    to.col(i) = truth.images[static_cast<std::size_t>(i)].pose.centre;
  }
  const Similarity place = best_similarity(from, to);
  std::vector<double> errors;
  for (const BundlePoint& point : found.points)
    errors.push_back((place(point.position) - truth.points[point.source].position).norm());
  return upper_median(std::move(errors));
}

std::vector<std::string> moved_lines(const Refined& found) {
  std::vector<std::string> lines;
  for (const HousingNumber& moved : diagnosis::moved_numbers(found.bundle, found.options.adjust))
    lines.push_back(diagnosis::text_of(moved, "main"));
  return lines;
}

struct Case {
  const char* name;
  refractive::Port<double> port;
  double distance;
  Errors errors;
};

std::ostream& operator<<(std::ostream& out, const Case& one) {
  return out << one.name;
}

class WronglyMeasured : public ::testing::TestWithParam<Case> {};

// What a ruler leaves wrong costs no more than the noise; with the numbers fixed it costs far more.
TEST_P(WronglyMeasured, NumbersAreFound) {
  const auto& [name, port, distance, errors] = GetParam();
  const Bundle truth = true_survey(port, distance);
  const double right = point_error(refined(truth, {}, "auto", true, false).bundle, truth);
  const Refined fixed = refined(truth, errors, "none");
  const Refined freed = refined(truth, errors, "auto");
  EXPECT_GT(point_error(fixed.bundle, truth), 2 * right);
  EXPECT_LT(point_error(freed.bundle, truth), 1.15 * right);
  // A single wrong number is found alone: the others keep their values, as if all were known.
  if (errors.count() == 1) {
    EXPECT_LT(point_error(freed.bundle, truth),
              1.15 * point_error(refined(truth, {}, "none").bundle, truth));
  }
  EXPECT_TRUE(freed.report.last.converged);
  EXPECT_TRUE(moved_lines(freed).empty());
  // If the numbers stay fixed, one of them is named.
  EXPECT_TRUE(diagnosis::number_that_does_not_fit(fixed.bundle, fixed.options.adjust));
  EXPECT_FALSE(diagnosis::number_that_does_not_fit(freed.bundle, freed.options.adjust));
}

const Errors kAllAtOnce{-2, 0.005, -0.006, 0.005, {}};

INSTANTIATE_TEST_SUITE_P(
    Rows, WronglyMeasured,
    ::testing::Values(Case{"Focal", flat_port(0), 2.5, {.focal = 0.01}},
                      Case{"FocalCloseUp", flat_port(2), 0.7, {.focal = 0.01}},
                      Case{"Index", flat_port(0), 2.5, {.index = -0.008}},
                      Case{"IndexCloseUp", flat_port(2), 0.7, {.index = -0.008}},
                      Case{"Tilt", flat_port(3), 2.5, {.tilt_degrees = -3}},
                      Case{"TiltCloseUp", flat_port(3), 0.7, {.tilt_degrees = -3}},
                      Case{"All", flat_port(3), 2.5, kAllAtOnce},
                      Case{"AllCloseUp", flat_port(3), 0.7, kAllAtOnce},
                      Case{"Dome", dome_port(), 2.5, {.centre = {0.003, 0, 0.005}}}),
    [](const auto& tested) { return tested.param.name; });

// Right numbers, estimated, cost little, and next to nothing if they are known well.
TEST(RightlyMeasured, NumbersStayNearThem) {
  HousingChange<double> calibrated;
  calibrated << 0.02 * kDegree, 0.02 * kDegree, 2e-4, 1e-4, 0, 1e-4;
  double fixed = 0, freed = 0, freed_calibrated = 0;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Bundle truth = true_survey(flat_port(2), 1.5, seed);
    const Refined held = refined(truth, {}, "none"), found = refined(truth, {}, "auto");
    fixed += point_error(held.bundle, truth);
    freed += point_error(found.bundle, truth);
    EXPECT_FALSE(diagnosis::number_that_does_not_fit(held.bundle, held.options.adjust));
    EXPECT_TRUE(moved_lines(found).empty());
    truth.cameras[0].stated_sigma = calibrated;
    freed_calibrated += point_error(refined(truth, {}, "auto").bundle, truth);
  }
  EXPECT_LT(freed, 1.03 * fixed);
  EXPECT_LT(freed_calibrated, 1.03 * fixed);
}

Errors drawn_errors(std::mt19937_64& random) {
  std::normal_distribution<double> normal(0, 1);
  const Sigmas ruler = ruler_sigmas();
  Errors errors;
  errors.tilt_degrees = ruler.normal_degrees * normal(random);
  errors.distance = ruler.distance * normal(random);
  errors.index = ruler.index * normal(random);
  errors.focal = ruler.focal * normal(random);
  errors.centre = ruler.centre * axial::test::drawn<3>(normal, random);
  return errors;
}

// How many of the results are within three standard deviations of the truth.
struct Honesty {
  int results = 0, within = 0;

  void add(double error, double sigma) {
    ++results;
    within += std::abs(error) <= 3 * sigma ? 1 : 0;
  }
  void expect_at_least(double part) const { EXPECT_GE(within, part * results) << "of " << results; }
};

// The truth minus the results: the errors that remain after the measured errors were corrected.
void add_numbers(const Refined& found, const Bundle& truth, const Uncertainty& known,
                 Honesty& numbers) {
  const auto values = free_values(found.bundle, known.camera_sigmas, found.options.adjust);
  const auto right = free_values(truth, {}, found.options.adjust);
  const double focal =
      found.bundle.cameras[0].now().lens.pinhole.fx / truth.cameras[0].measured.lens.pinhole.fx;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool is_focal = values[i].quantity == Quantity::focal;
    numbers.add(is_focal ? focal - 1 : values[i].now - right[i].now, values[i].sigma);
  }
}

class RulerErrors : public ::testing::TestWithParam<Case> {};

// Over draws of a ruler's errors: the numbers and the scale, which only refraction determines here.
TEST_P(RulerErrors, AreCorrectedWithinTheStatedDeviations) {
  const auto& [name, port, distance, unused] = GetParam();
  std::mt19937_64 random(7);
  Honesty numbers, scales, fixed_scales;
  for (unsigned draw = 1; draw <= 20; ++draw) {
    const Bundle truth = true_survey(port, distance, draw, 80);
    const Errors errors = drawn_errors(random);
    const Refined found = refined(truth, errors, "auto", false);
    const Uncertainty known = uncertainty(found.bundle, found.options.adjust);
    add_numbers(found, truth, known, numbers);
    scales.add(std::log(testing::pose_errors(found.bundle, truth).scale), known.scale_sigma);
    const Refined fixed = refined(truth, errors, "none", false);
    fixed_scales.add(std::log(testing::pose_errors(fixed.bundle, truth).scale),
                     uncertainty(fixed.bundle, fixed.options.adjust).scale_sigma);
  }
  numbers.expect_at_least(0.95);
  scales.expect_at_least(0.95);
  fixed_scales.expect_at_least(0.95);
}

INSTANTIATE_TEST_SUITE_P(Ports, RulerErrors,
                         ::testing::Values(Case{"Flat", flat_port(2, 0.03), 0.8, {}},
                                           Case{"Dome", dome_port(), 0.5, {}}),
                         [](const auto& tested) { return tested.param.name; });

// The standard deviation of the scale has the effect of each fixed number: one standard deviation
// of the number, and the scale that the adjustment then finds.
TEST(Uncertainty, OfTheScaleIncludesNumbersThatStayFixed) {
  const Bundle truth = true_survey(flat_port(2, 0.03), 0.8);
  Refined found = refined(truth, {}, "none", false);
  const AdjustOptions& adjusting = found.options.adjust;
  AdjustOptions exact;
  const double alone = uncertainty(found.bundle, exact).scale_sigma;
  double variance = alone * alone;
  constexpr double kPart = 0.1;  // of the standard deviation: the scale is not linear
  for (int k = 0; k < kHousingNumbers; ++k) {
    const double sigma = adjusting.sigma_before(found.bundle.cameras[0], k);
    if (!(sigma > 0)) continue;
    double scales[2];
    for (const int side : {0, 1}) {
      Bundle moved = found.bundle;
      moved.cameras[0].change(k) += (side == 0 ? -1 : 1) * kPart * sigma;
      AdjustOptions many = exact;
      many.pixel_sigma = observed_pixel_sigma(found.bundle, exact);
      adjust(moved, many);
      scales[side] = testing::pose_errors(moved, found.bundle).scale;
    }
    variance += std::pow(std::log(scales[1] / scales[0]) / (2 * kPart), 2);
  }
  EXPECT_GT(variance, 4 * alone * alone);
  EXPECT_NEAR(uncertainty(found.bundle, adjusting).scale_sigma / std::sqrt(variance), 1, 0.05);
}

TEST(MovedNumbers, AreNamedWithBothValues) {
  const Bundle truth = true_survey(flat_port(2), 0.8);
  const Refined found = refined(truth, {.index = 0.03}, "auto");
  const auto lines = moved_lines(found);
  ASSERT_FALSE(lines.empty());
  EXPECT_THAT(lines, ::testing::Contains(::testing::AllOf(HasSubstr("Camera 1 behind main"),
                                                          HasSubstr("index of water 1.33"),
                                                          HasSubstr("stated 1.363 +- 0.004"))));
}

// A port that nearly touches the lens: the distance stays possible.
TEST(MeasuredDistance, DoesNotBecomeNegative) {
  const Bundle truth = true_survey(flat_port(0, 0.001), 2.5);
  const Refined found = refined(truth, {.distance = 0.006}, "auto");
  EXPECT_GE(std::get<Flat>(*found.bundle.cameras[0].now().port).distance, 0);
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const Bundle other = true_survey(flat_port(0, 0), 0.7, seed, 100);
    const Refined near = refined(other, {.distance = 0.001}, "auto");
    EXPECT_GE(std::get<Flat>(*near.bundle.cameras[0].now().port).distance, 0);
  }
}

class EstimatedNumbers : public ::testing::Test {
 protected:
  Bundle flat_ = survey(camera_behind(flat_port()), {.images = 4, .points = 40});
  AdjustOptions adjust_;

  double sigma(int number) const { return adjust_.sigma_before(flat_.cameras[0], number); }
};

TEST_F(EstimatedNumbers, AreAllButTheThickness) {
  set_estimated_numbers("auto", {}, flat_, adjust_);
  EXPECT_EQ(adjust_.free, (std::array{true, true, true, true, false, true}));
  EXPECT_DOUBLE_EQ(sigma(0), 3 * kDegree);
  EXPECT_EQ(sigma(2), 0.005);
  EXPECT_EQ(sigma(kIndexNumber), 0.004);
  EXPECT_EQ(sigma(kThicknessNumber), 0);
  EXPECT_EQ(sigma(kFocalNumber), 0.005);
  adjust_.poses_known = true;
  set_estimated_numbers("auto", {}, flat_, adjust_);
  EXPECT_EQ(std::ranges::count(adjust_.free, true), 0);
}

// An option has priority over the file, and the file over the ruler.
TEST_F(EstimatedNumbers, TakeTheMostSpecificDeviation) {
  flat_.cameras[0].stated_sigma(2) = 0.002;
  flat_.cameras[0].stated_sigma(kThicknessNumber) = 0.0001;
  set_estimated_numbers("auto", {}, flat_, adjust_);
  EXPECT_EQ(sigma(2), 0.002);
  EXPECT_EQ(sigma(kThicknessNumber), 0.0001);
  EXPECT_TRUE(adjust_.free[kThicknessNumber]);
  Sigmas given;
  given.distance = 0.001;
  set_estimated_numbers("auto", given, flat_, adjust_);
  EXPECT_EQ(sigma(2), 0.001);
}

// A list frees its numbers as before: without a stated deviation they count as not measured.
TEST_F(EstimatedNumbers, OfAListAndNoneKeepTheirDoubt) {
  set_estimated_numbers("none", {}, flat_, adjust_);
  EXPECT_EQ(std::ranges::count(adjust_.free, true), 0);
  EXPECT_EQ(sigma(2), 0.005);
  set_estimated_numbers("normal", {}, flat_, adjust_);
  EXPECT_EQ(adjust_.free, (std::array{true, true, false, false, false, false}));
  EXPECT_EQ(sigma(0), 0);
  EXPECT_EQ(sigma(2), 0.005);
  flat_.cameras[0].stated_sigma(2) = 0.002;
  set_estimated_numbers("distance", {}, flat_, adjust_);
  EXPECT_EQ(sigma(2), 0.002);
}

TEST_F(EstimatedNumbers, OfDomesAndOfCamerasInAirAreTheirOwn) {
  Bundle both = testing::mixed_survey(camera_behind(flat_port()), camera_behind(dome_port()),
                                      {.images = 4, .points = 40});
  both.cameras.push_back(both.cameras[0]);
  both.cameras[2].measured.port.reset();
  set_estimated_numbers("auto", {}, both, adjust_);
  const auto free = [&](std::size_t camera) { return adjust_.unknowns(both.cameras[camera]).free; };
  EXPECT_EQ(free(0), (std::array{true, true, true, true, false, true}));
  EXPECT_EQ(free(1), (std::array{true, true, true, true, false, true}));
  EXPECT_EQ(free(2), (std::array{false, false, false, false, false, true}));
  EXPECT_DOUBLE_EQ(adjust_.sigma_before(both.cameras[0], 0), 3 * kDegree);
  EXPECT_EQ(adjust_.sigma_before(both.cameras[1], 0), 0.005);
}

TEST_F(EstimatedNumbers, RefuseDeviationsThatHaveNoUse) {
  Sigmas given;
  given.centre = 0.01;
  EXPECT_THAT(test::error_of([&] { set_estimated_numbers("auto", given, flat_, adjust_); }),
              HasSubstr("centre_sigma 0.01: refine auto does not name centre"));
  EXPECT_THAT(test::error_of([&] { set_estimated_numbers("none", given, flat_, adjust_); }),
              HasSubstr("refine none does not name centre"));
}

}  // namespace
}  // namespace axial::pose
