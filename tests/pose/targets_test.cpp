// SPDX-License-Identifier: GPL-3.0-or-later
// Targets, bars and known places in refractive bundle adjustment.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "pose/adjust/uncertainty.h"
#include "pose/bundle/free_motions.h"
#include "pose/bundle/known.h"
#include "pose/control/control_fit.h"
#include "pose/control/control_start.h"
#include "pose/control/target_shape.h"
#include "pose/refine.h"
#include "pose/target_survey.h"
#include "scene/decompositions.h"

namespace axial::pose {
namespace {

using testing::absorbed;
using testing::camera_behind;
using ::testing::ContainsRegex;
using testing::dome_port;
using testing::flat_port;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::Plate;
using testing::seen_plates;
using testing::SeenPlates;
using ::testing::SizeIs;
using testing::survey;
using testing::target_named;

constexpr double kBar = 0.5;  // [m]
// From the frame of the plates, in which the cameras look along z, to a world in which they look
// down.
const Eigen::DiagonalMatrix<double, 3> kDown(1, -1, -1);

// Plates at both ends of three bars, and single plates at four corners. The survey is 2 m from the
// ground.
std::vector<Plate> plates(bool square = false) {
  const Eigen::Vector3d up = Eigen::Vector3d(0.1, -0.15, -1).normalized();
  std::vector<Plate> found;
  const auto add = [&](double x, double y, double z) {
    found.push_back({"target " + std::to_string(found.size() + 1), {x, y, z}, up, 0.03, square});
  };
  add(-0.7, -0.3, 2), add(-0.7 + kBar, -0.3, 2);
  add(0.2, 0.1, 2.1), add(0.2, 0.1 + kBar, 2.1);
  add(0.1, -0.4, 1.9), add(0.1 + kBar, -0.4, 1.9);
  add(-0.8, -0.5, 2.1), add(0.8, -0.5, 1.9), add(-0.8, 0.5, 2), add(0.8, 0.55, 2.1);
  return found;
}

Bundle true_survey(unsigned seed = 1) {
  return survey(camera_behind(flat_port(2, 0.04)),
                {.distance = 2, .images = 16, .points = 250, .noise = 0.3, .seed = seed});
}

// The length between two targets.
KnownDistance bar(const std::vector<Target>& targets, int first, double metres, double sigma) {
  const auto label = [](int number) { return "target " + std::to_string(number); };
  return {KnownDistance::Between::points,
          target_named(targets, label(first)).source,
          target_named(targets, label(first + 1)).source,
          metres,
          sigma,
          "The bar " + label(first) + "-" + label(first + 1)};
}

KnownPlace place(const std::vector<Target>& targets, const Plate& plate,
                 const Eigen::Vector3d& error, double sigma) {
  return {KnownDistance::Between::points, target_named(targets, plate.label).source,
          kDown * plate.centre + error, Eigen::Vector3d::Constant(sigma), plate.label};
}

// A survey with targets as RefinePoses gets it: poses of a pinhole engine at a wrong scale.
struct Dive {
  Bundle truth, bundle;
  std::vector<Plate> plates = pose::plates();
  RefineOptions options;

  explicit Dive(unsigned seed = 1, double noise = 0.05) : truth(true_survey(seed)) {
    bundle = absorbed(truth, 0.37);
    options.targets = seen_plates(truth, plates, noise, seed).targets;
    add_targets(bundle, options.targets);
  }

  RefineReport refine() {
    bring_to_metres(bundle, options.adjust);
    RefineReport report = pose::refine(bundle, options);
    options.adjust.distances = report.distances;
    options.adjust.places = report.places;
    return report;
  }
};

double largest(const std::vector<Eigen::Vector2d>& vectors) {
  double result = 0;
  for (const Eigen::Vector2d& one : vectors) result = std::max(result, one.norm());
  return result;
}

class Shape : public ::testing::TestWithParam<bool> {};

// The witness of a ring is the centroid of the area of its image, computed from its outline. A
// large, oblique dot differs from an ellipse by refraction, which leaves 0.01 px.
TEST_P(Shape, CorrectsTheCentreByTheTrueRays) {
  const Bundle truth = true_survey();
  Plate plate{
      "target 1", {0.2, 0.1, 2}, Eigen::Vector3d(0.8, 0.3, -1).normalized(), 0.15, GetParam()};
  const SeenPlates seen = seen_plates(truth, {plate}, 0, 1);
  const std::vector<PhotographCamera> cameras = cameras_now(truth);
  std::vector<Eigen::Vector2d> corrections =
      centre_corrections(truth, cameras, seen.targets[0], plate.centre);
  ASSERT_GT(corrections.size(), 5);
  std::vector<Eigen::Vector2d> errors, uncorrected;
  for (std::size_t i = 0; i < corrections.size(); ++i) {
    const Eigen::Vector2d off = seen.targets[0].images[i].pixel - seen.centres[0][i];
    uncorrected.push_back(off);
    errors.push_back(off + corrections[i]);
  }
  EXPECT_GT(largest(uncorrected), 0.2);
  EXPECT_LT(largest(errors), 0.01);
}

INSTANTIATE_TEST_SUITE_P(Of, Shape, ::testing::Values(false, true),
                         [](const auto& shape) { return shape.param ? "Square" : "Ring"; });

TEST(FreeMotions, AreThoseThatChangeNoKnownCoordinate) {
  Dive dive;
  dive.bundle = dive.truth;
  drop_targets(dive.bundle);
  add_targets(dive.bundle, dive.options.targets);
  AdjustOptions options;
  const auto count = [&] { return free_motions(dive.bundle, options).size(); };
  EXPECT_EQ(count(), 6);
  const auto add = [&](std::size_t plate) {
    options.places.push_back(
        place(dive.options.targets, dive.plates[plate], Eigen::Vector3d::Zero(), 0.01));
  };
  add(6);
  EXPECT_EQ(count(), 3);
  add(7);
  EXPECT_EQ(count(), 1);
  add(8);
  EXPECT_EQ(count(), 0);
  for (KnownPlace& known : options.places)
    known.sigma.head(2).setConstant(std::numeric_limits<double>::infinity());
  EXPECT_EQ(count(), 3);  // heights alone
  for (const Motion& motion : free_motions(dive.bundle, options))
    for (const KnownPlace& known : options.places)
      EXPECT_NEAR(motion.shift_of(place_in(dive.bundle, known.of, known.index)).z(), 0, 1e-9);
}

// The bars lie in error by their standard deviation, so that the check bar and the scale scatter.
TEST(Bars, DetermineTheScaleAsWellAsStated) {
  constexpr int kDraws = 12;
  constexpr double kSigma = 2e-4;
  double squares = 0;
  for (unsigned draw = 1; draw <= kDraws; ++draw) {
    std::mt19937_64 random(draw);
    std::normal_distribution<double> normal(0, kSigma);
    Dive dive(draw);
    const std::vector<Target>& targets = dive.options.targets;
    for (const int first : {1, 3})
      dive.options.adjust.distances.push_back(bar(targets, first, kBar + normal(random), kSigma));
    const RefineReport report = dive.refine();
    EXPECT_THAT(report.wrong_control, IsEmpty()) << draw;
    const std::vector<KnownDistance> check{bar(targets, 5, kBar, 1e-6)};
    const ControlFits fits = control_fits(dive.bundle, dive.options.adjust, check, {}, false);
    squares += std::pow(fits.distances[0].deviation(), 2);
    EXPECT_LT(std::abs(fits.distances[0].off()), 1e-3);
    const Uncertainty known = uncertainty(dive.bundle, dive.options.adjust);
    const double scale = testing::pose_errors(dive.bundle, dive.truth).scale;
    EXPECT_LT(std::abs(scale - 1), 4 * known.scale_sigma) << draw;
    EXPECT_LT(known.scale_sigma, 1e-3);
  }
  // The mean of the squares of 12 normal numbers is between 0.3 and 2.2 in 99 % of all cases.
  EXPECT_GT(squares / kDraws, 0.3);
  EXPECT_LT(squares / kDraws, 2.2);
}

TEST(Bars, AreNamedIfOneIsWrong) {
  Dive dive;
  const std::vector<Target>& targets = dive.options.targets;
  for (const int first : {1, 3})
    dive.options.adjust.distances.push_back(bar(targets, first, kBar, 2e-4));
  dive.options.adjust.distances.push_back(bar(targets, 5, kBar + 0.01, 2e-4));
  const RefineReport report = dive.refine();
  ASSERT_THAT(report.wrong_control, SizeIs(1));
  EXPECT_THAT(report.wrong_control[0], ContainsRegex("target 5-target 6 is (9.9|10).* mm shorter"));
  EXPECT_THAT(report.wrong_control[0], HasSubstr("left out"));
  EXPECT_NEAR(testing::pose_errors(dive.bundle, dive.truth).scale, 1, 1e-3);
}

TEST(Bars, AreNamedIfOneIsInFeet) {
  Dive dive;
  const std::vector<Target>& targets = dive.options.targets;
  for (const int first : {1, 3})
    dive.options.adjust.distances.push_back(bar(targets, first, kBar, 2e-4));
  dive.options.adjust.distances.push_back(bar(targets, 5, kBar / 0.3048, 2e-4));
  const RefineReport report = dive.refine();
  ASSERT_THAT(report.wrong_control, SizeIs(1));
  EXPECT_THAT(report.wrong_control[0], HasSubstr("feet"));
}

// Two bars contradict each other, and a moved plate is found all the same.
TEST(Bars, ThatContradictEachOtherDoNotHideOtherErrors) {
  Dive dive;
  const std::vector<Target>& targets = dive.options.targets;
  for (std::size_t plate = 0; plate < 10; ++plate) {
    KnownPlace known = place(targets, dive.plates[plate], Eigen::Vector3d::Zero(), 0.005);
    known.sigma.head(2).setConstant(std::numeric_limits<double>::infinity());
    if (plate == 7) known.metres.z() += 0.3;
    dive.options.adjust.places.push_back(known);
  }
  dive.options.adjust.distances.push_back(bar(targets, 1, kBar, 2e-4));
  dive.options.adjust.distances.push_back(bar(targets, 5, kBar + 0.01, 2e-4));
  const RefineReport report = dive.refine();
  ASSERT_THAT(report.wrong_control, SizeIs(2));
  EXPECT_THAT(report.wrong_control[0], HasSubstr("target 8"));
  EXPECT_THAT(report.wrong_control[1], HasSubstr("contradict"));
}

TEST(Bars, ThatContradictEachOtherAreBothNamed) {
  Dive dive;
  const std::vector<Target>& targets = dive.options.targets;
  dive.options.adjust.distances.push_back(bar(targets, 1, kBar, 2e-4));
  dive.options.adjust.distances.push_back(bar(targets, 5, kBar + 0.01, 2e-4));
  const RefineReport report = dive.refine();
  ASSERT_THAT(report.wrong_control, SizeIs(1));
  EXPECT_THAT(report.wrong_control[0], HasSubstr("contradict"));
  EXPECT_THAT(report.distances, SizeIs(2));
}

// Three of four plates lie nearly on a line. The wrong plate draws those to itself that only it
// controls, so that its own deviation may be the smaller one.
TEST(Places, OfWhichOneIsWrongAreToldByTheCostWithoutIt) {
  constexpr double kSigma = 0.005, kMoved = 0.15;
  const std::vector<std::size_t> four{5, 6, 7, 9};
  for (const std::size_t moved : four) {
    Dive dive;
    for (const std::size_t plate : four) {
      const Eigen::Vector3d error =
          plate == moved ? Eigen::Vector3d(kMoved, 0, 0) : Eigen::Vector3d(Eigen::Vector3d::Zero());
      dive.options.adjust.places.push_back(
          place(dive.options.targets, dive.plates[plate], error, kSigma));
    }
    const RefineReport report = dive.refine();
    ASSERT_THAT(report.wrong_control, SizeIs(1)) << moved;
    EXPECT_THAT(report.wrong_control[0], HasSubstr(dive.plates[moved].label + " is "));
    EXPECT_THAT(report.wrong_control[0], HasSubstr("left out"));
  }
}

// Four plates at the corners with errors of 10 mm, and single plates as checks.
TEST(Places, PlaceTheModelAsWellAsStated) {
  constexpr int kDraws = 8;
  constexpr double kSigma = 0.01;
  double squares = 0, count = 0;
  for (unsigned draw = 1; draw <= kDraws; ++draw) {
    std::mt19937_64 random(draw);
    std::normal_distribution<double> normal(0, kSigma);
    Dive dive(draw);
    const auto error = [&] {
      const double x = normal(random), y = normal(random);
      return Eigen::Vector3d(x, y, normal(random));
    };
    for (const std::size_t plate : {6u, 7u, 8u, 9u})
      dive.options.adjust.places.push_back(
          place(dive.options.targets, dive.plates[plate], error(), kSigma));
    const RefineReport report = dive.refine();
    EXPECT_THAT(report.wrong_control, IsEmpty()) << draw;
    std::vector<KnownPlace> checks;
    for (const std::size_t plate : {0u, 3u, 5u})
      checks.push_back(
          place(dive.options.targets, dive.plates[plate], Eigen::Vector3d::Zero(), 1e-5));
    for (const PlaceFit& fit :
         control_fits(dive.bundle, dive.options.adjust, {}, checks, false).places)
      for (const KnownFit& coordinate : fit.coordinates) {
        squares += std::pow(coordinate.deviation(), 2);
        ++count;
        EXPECT_LT(std::abs(coordinate.off()), 0.05);
      }
  }
  // 12 numbers of a placement are estimated in each draw; their errors are common to the checks.
  EXPECT_GT(squares / count, 0.4);
  EXPECT_LT(squares / count, 2);
}

TEST(Places, AreNamedIfAPlateWasMoved) {
  for (unsigned draw = 1; draw <= 4; ++draw) {
    std::mt19937_64 random(draw);
    std::normal_distribution<double> normal(0, 0.01);
    Dive dive(draw);
    for (std::size_t plate = 6; plate < 10; ++plate) {
      const double x = normal(random), y = normal(random);
      Eigen::Vector3d error(x, y, normal(random));
      if (plate == 6 + draw % 4) error.x() += 0.3;
      dive.options.adjust.places.push_back(
          place(dive.options.targets, dive.plates[plate], error, 0.01));
    }
    // The scale is known, so that three plates control the fourth.
    dive.options.adjust.distances.push_back(bar(dive.options.targets, 1, kBar, 2e-4));
    const RefineReport report = dive.refine();
    ASSERT_THAT(report.wrong_control, SizeIs(1)) << draw;
    EXPECT_THAT(report.wrong_control[0], HasSubstr(dive.plates[6 + draw % 4].label));
  }
}

TEST(Places, AreNamedIfLabelsAreExchanged) {
  Dive dive;
  for (std::size_t plate = 0; plate < 10; ++plate) {
    Plate stated = dive.plates[plate];
    if (plate == 3) stated.label = dive.plates[8].label;
    if (plate == 8) stated.label = dive.plates[3].label;
    dive.options.adjust.places.push_back(
        place(dive.options.targets, stated, Eigen::Vector3d::Zero(), 0.005));
  }
  const RefineReport report = dive.refine();
  ASSERT_THAT(report.wrong_control, SizeIs(2));
  for (const std::string& line : report.wrong_control) EXPECT_THAT(line, HasSubstr("exchanged"));
}

// Two places in the plane do not determine the turn about their line. The cameras look down for any
// error of the coordinates.
TEST(Places, InThePlaneDoNotTurnTheModelOver) {
  for (unsigned draw = 1; draw <= 8; ++draw) {
    std::mt19937_64 random(draw);
    std::uniform_real_distribution<double> place(-1, 1);
    Dive dive;
    for (const std::size_t plate : {6u, 7u, 8u}) {
      if (plate == 8 && draw <= 4) continue;
      const double x = place(random), y = place(random);
      dive.options.adjust.places.push_back(
          pose::place(dive.options.targets, dive.plates[plate], Eigen::Vector3d(x, y, 0), 0.01));
      dive.options.adjust.places.back().sigma.z() = std::numeric_limits<double>::infinity();
    }
    place_by_control(dive.bundle, dive.options.adjust);
    for (const BundleImage& image : dive.bundle.images)
      EXPECT_LT(image.pose.rotation(2, 2), -0.7) << draw;
    if (draw > 4) continue;
    // Without bars, the distance of two places is the scale, so that the model meets both.
    for (const KnownPlace& known : dive.options.adjust.places) {
      const Eigen::Vector3d found = place_in(dive.bundle, known.of, known.index);
      EXPECT_LT((found - known.metres).head<2>().norm(), 1e-9);
    }
  }
}

TEST(Places, OfCamerasPlaceAModelWithoutTargets) {
  Dive dive;
  dive.options.targets.clear();
  dive.bundle = absorbed(dive.truth, 0.37);
  const Eigen::Vector3d shift(100, 200, -20);
  for (const std::size_t image : {0u, 5u, 10u, 15u})
    dive.options.adjust.places.push_back({KnownDistance::Between::images, image,
                                          dive.truth.images[image].pose.centre + shift,
                                          Eigen::Vector3d::Constant(0.002), "camera"});
  dive.refine();
  // The four places have errors of 0 and a standard deviation of 2 mm; observations have 0.3 px.
  for (std::size_t i = 0; i < dive.truth.images.size(); ++i)
    EXPECT_LT((dive.bundle.images[i].pose.centre - dive.truth.images[i].pose.centre - shift).norm(),
              0.01);
}

TEST(Places, WithNorthingBeforeEastingAreNamed) {
  Dive dive;
  for (const Plate& plate : dive.plates) {
    KnownPlace known = place(dive.options.targets, plate, Eigen::Vector3d::Zero(), 0.005);
    std::swap(known.metres.x(), known.metres.y());
    dive.options.adjust.places.push_back(known);
  }
  const RefineReport report = dive.refine();
  ASSERT_FALSE(report.wrong_control.empty());
  EXPECT_THAT(report.wrong_control.back(), HasSubstr("northing"));
}

TEST(Heights, AloneGiveNoLength) {
  AdjustOptions options;
  KnownPlace height;
  height.sigma.z() = 0.01;
  options.places.assign(3, height);
  EXPECT_FALSE(options.know_lengths());
  for (KnownPlace& place : options.places) place.sigma.head(2).setConstant(0.01);
  EXPECT_TRUE(options.know_lengths());
  options.places.clear();
  options.positions.resize(2);  // too few to place the model
  EXPECT_FALSE(options.know_lengths());
}

TEST(Bars, WhoseEndsCoincideAtTheStartDoNotScale) {
  Dive dive;
  const std::vector<Target>& targets = dive.options.targets;
  for (const int first : {1, 3})
    dive.options.adjust.distances.push_back(bar(targets, first, kBar, 2e-4));
  dive.options.adjust.distances.push_back(bar(targets, 5, kBar, 2e-4));
  dive.options.adjust.distances.back().second = dive.options.adjust.distances.back().first;
  EXPECT_NO_THROW(bring_to_metres(dive.bundle, dive.options.adjust));
  // The two other bars scale the poses of a pinhole engine, which absorbed some per cent.
  EXPECT_NEAR(testing::pose_errors(dive.bundle, dive.truth).scale, 1, 0.1);
}

// Heights determine up and down, and no more. The world of the plates is turned, so that up is not
// an axis of the model.
TEST(Heights, TurnTheModelUpright) {
  Dive dive;
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(2.9, Eigen::Vector3d::UnitX()) *
                                Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()))
                                   .toRotationMatrix();
  for (const Plate& plate : dive.plates) {
    KnownPlace known = place(dive.options.targets, plate, Eigen::Vector3d::Zero(), 0.002);
    known.metres = turn * plate.centre + Eigen::Vector3d(0, 0, -20);
    known.sigma.head(2).setConstant(std::numeric_limits<double>::infinity());
    dive.options.adjust.places.push_back(known);
  }
  dive.options.adjust.distances.push_back(bar(dive.options.targets, 1, kBar, 2e-4));
  const RefineReport report = dive.refine();
  EXPECT_THAT(report.wrong_control, IsEmpty());
  for (std::size_t i = 0; i < dive.plates.size(); ++i) {
    const KnownPlace& known = dive.options.adjust.places[i];
    EXPECT_NEAR(place_in(dive.bundle, known.of, known.index).z(), known.metres.z(), 0.005);
  }
  for (std::size_t i = 0; i < dive.bundle.images.size(); ++i) {
    const double height = dive.bundle.images[i].pose.centre.z();
    EXPECT_NEAR(height, (turn * dive.truth.images[i].pose.centre).z() - 20, 0.01);
  }
}

TEST(Labels, OfTwoPlatesAreNamed) {
  Dive dive;
  Target& first = dive.options.targets[0];
  const Target& other = dive.options.targets[9];
  for (TargetImage& image : first.images)
    for (const TargetImage& seen : other.images)
      if (seen.image == image.image && image.image % 2 == 0) image = seen;
  dive.bundle = absorbed(dive.truth, 0.37);
  add_targets(dive.bundle, dive.options.targets);
  dive.options.adjust.distances.push_back(bar(dive.options.targets, 1, kBar, 2e-4));
  dive.options.adjust.distances.push_back(bar(dive.options.targets, 3, kBar, 2e-4));
  const RefineReport report = dive.refine();
  ASSERT_THAT(report.wrong_control, SizeIs(2));
  EXPECT_THAT(report.wrong_control[0], HasSubstr("target 1 is left out"));
  EXPECT_THAT(report.wrong_control[1], HasSubstr("The bar target 1-target 2 is not used"));
  EXPECT_NEAR(testing::pose_errors(dive.bundle, dive.truth).scale, 1, 1e-3);
}

// Errors of lens and plates are found in the residuals of targets.
TEST(TargetSigma, ExplainsTheErrors) {
  Dive dive(1, 0.2);
  for (Target& target : dive.options.targets)
    for (TargetImage& image : target.images) image.sigma = 0.02;
  dive.options.adjust.distances.push_back(bar(dive.options.targets, 1, kBar, 2e-4));
  dive.refine();
  for (const Observation& one : dive.bundle.observations)
    if (dive.bundle.points[one.point].is_target) {
      EXPECT_GT(one.target_sigma, 0.14);
      EXPECT_LT(one.target_sigma, 0.28);
    }
}

}  // namespace
}  // namespace axial::pose
