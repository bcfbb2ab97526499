// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/registration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "compare/write_changes.h"
#include "io/bytes/json.h"
#include "map/map_place.h"
#include "support/empty_folder.h"
#include "support/error_of.h"
#include "two_surveys.h"

namespace axial::test {
namespace {

using namespace compare;
using testing::HasSubstr;

const map::MapFrame kMapFrame;

Registration registered(const Mesh& before, const Mesh& after, double pixel = 0.0125) {
  return register_surveys(before, after, kMapFrame, map::grid_around(before, kMapFrame, pixel));
}

TEST(Registration, FindsTheMotionInSpiteOfChanges) {
  const RigidMotion truth = small_motion();
  const Mesh after = moved_back(survey_after(), truth);
  const Registration found = registered(survey_before(), after);
  EXPECT_TRUE(found.converged);
  EXPECT_EQ(found.determined, 6);
  const Vector6d error = error_of_motion(found.motion, truth);
  const Vector6d sigma = found.covariance.diagonal().cwiseSqrt();
  for (int k = 0; k < 6; ++k) EXPECT_LT(std::abs(error[k]), 4 * sigma[k]) << k;
  // The stated uncertainty is useful: below a tenth of the noise.
  EXPECT_LT(sigma.tail<3>().maxCoeff(), 2e-4);
  EXPECT_LT(sigma.head<3>().maxCoeff(), 2e-4);
  // The boulders and the coral cover 6 % of the plot.
  EXPECT_GT(found.share_used, 0.7);
  EXPECT_LT(found.share_used, 0.95);
}

TEST(Registration, StatesItsUncertainty) {
  constexpr int kRuns = 30;
  const RigidMotion truth = small_motion();
  const Plot small{.high = {1.8, 1.4}, .spacing = 0.02, .noise = 0.003};
  Vector6d sum = Vector6d::Zero();
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    Plot first = small, second = small;
    first.seed = 100 + 2 * run, second.seed = 101 + 2 * run;
    second.low += Eigen::Vector2d(0.007, 0.003);
    const Mesh after = moved_back(surveyed(second, hills), truth);
    const Registration found = registered(surveyed(first, hills), after, 0.02);
    const Vector6d error = error_of_motion(found.motion, truth);
    sum += error.cwiseAbs2().cwiseQuotient(found.covariance.diagonal());
  }
  // The mean of the squared errors in standard deviations is 1 +- 0.26.
  for (int k = 0; k < 6; ++k) {
    EXPECT_GT(sum[k] / kRuns, 0.4) << k;
    EXPECT_LT(sum[k] / kRuns, 2.0) << k;
  }
}

TEST(Registration, HeightVarianceIsThatOfTheMotion) {
  Registration registration;
  registration.motion.centre = {1, 2, 3};
  registration.covariance(0, 0) = 1e-4;  // rotation about x
  registration.covariance(3, 3) = 4e-4;  // translation along x
  registration.covariance(5, 5) = 9e-4;  // along z
  EXPECT_NEAR(registration.height_variance({1, 2, 3}, {0, 0}), 9e-4, 1e-12);
  EXPECT_NEAR(registration.height_variance({1, 4, 3}, {0, 0}), 9e-4 + 4 * 1e-4, 1e-12);
  EXPECT_NEAR(registration.height_variance({1, 2, 3}, {0.5, 0}), 9e-4 + 1e-4, 1e-12);
}

TEST(Registration, DoesNotMoveAlongLevelGround) {
  const auto level = [](double, double) { return 0.0; };
  const Mesh before = surveyed({.seed = 5}, level);
  RigidMotion truth = small_motion();
  truth.rotation = Eigen::AngleAxisd(0.004, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const Registration found = registered(before, moved_back(surveyed({.seed = 6}, level), truth));
  EXPECT_EQ(found.determined, 3);
  const Vector6d sigma = found.covariance.diagonal().cwiseMax(0).cwiseSqrt();
  const Vector6d error = error_of_motion(found.motion, truth);
  for (const int k : {0, 1, 5}) EXPECT_LT(std::abs(error[k]), 4 * sigma[k]) << k;
  EXPECT_LT(found.motion.translation.head<2>().norm(), 1e-3);
}

TEST(Registration, LeavesIdenticalSurveysWhereTheyAre) {
  const Mesh mesh = survey_before();
  const Registration found = registered(mesh, mesh);
  EXPECT_TRUE(found.converged);
  EXPECT_EQ(found.iterations, 0);
  EXPECT_EQ(found.covariance, Matrix6d::Zero());
  EXPECT_EQ(moved(kMapFrame, found.motion).axes, kMapFrame.axes);
}

TEST(Registration, InWorldMovesPointsAsInTheMap) {
  const RigidMotion motion = small_motion({3, -2, 1});
  // Far from the origin of the world, and with heights from a place near the mesh.
  const LocalFrame near{{500, -300, 40}};
  const map::MapFrame frame = map::frame_with_up({0.2, -0.4, 0.7}, near);
  const Eigen::Vector3d x(0.3, 1.2, -0.8);
  const Similarity found = in_world(motion, map::world_axes(frame, near));
  EXPECT_LT((frame.to_map(near.to_local(found(near.to_world(x)))) - moved(frame, motion).to_map(x))
                .norm(),
            1e-11);
}

using ComparisonFile = FolderTest;

TEST_F(ComparisonFile, PlacesMapsOfTheLaterSurvey) {
  const LocalFrame near{{500, -300, 40}};
  Comparison comparison;
  comparison.frame = map::frame_with_up({0.2, -0.4, 0.7}, near);
  comparison.registration.motion = small_motion({3, -2, 1});
  ChangeFacts facts;
  facts.aligned = true;
  facts.mesh_frame = near;
  facts.crs = "a system";
  const std::filesystem::path file = folder_ / "a.change.json";
  write_atomically(file, io::to_text(to_json(comparison, facts)));
  const map::MapPlace place = map::place_of_map(file);
  EXPECT_EQ(place.crs, "a system");
  const Eigen::Vector3d x(0.3, 1.2, -0.8);
  const map::MapFrame later = moved(comparison.frame, comparison.registration.motion);
  EXPECT_LT((map::frame_on(place.axes, near).to_map(x) - later.to_map(x)).norm(), 1e-10);
  facts.aligned = false;
  write_atomically(file, io::to_text(to_json(comparison, facts)));
  EXPECT_LT(
      (map::frame_on(map::place_of_map(file).axes, near).to_map(x) - comparison.frame.to_map(x))
          .norm(),
      1e-10);
}

TEST(Registration, NeedsCommonGround) {
  const Mesh before = survey_before();
  const Mesh beside = surveyed({.low = {3.95, 2.95}, .high = {5, 4}}, hills);
  EXPECT_THAT(error_of([&] { registered(before, beside); }), HasSubstr("only 31 vertices over"));
  Mesh torn = before;
  torn.faces.resize(60);
  EXPECT_THAT(error_of([&] { registered(before, torn); }), HasSubstr("places in common"));
}

// A wrong position hides the flanks of the rocks among the changes.
TEST(Registration, StartsFarAway) {
  RigidMotion truth = small_motion({2, 1.5, 0});
  truth.translation *= 6;
  truth.rotation = Eigen::AngleAxisd(0.06, Eigen::Vector3d(0.3, -0.2, 0.9).normalized());
  const auto rocks = [](double x, double y) {
    double height = 0.2 * hills(x, y);
    for (const Boulder& rock : {Boulder{0.7, 0.8}, Boulder{2.9, 0.6}, Boulder{1.8, 2.2}})
      height += 2 * rock(x, y);
    return height;
  };
  const Mesh before = surveyed({.spacing = 0.025}, rocks);
  const Mesh after = surveyed({.spacing = 0.025, .seed = 9}, rocks);
  const Registration found = registered(before, moved_back(after, truth));
  EXPECT_TRUE(found.converged);
  EXPECT_LT(error_of_motion(found.motion, truth).tail<3>().norm(), 0.001);
}

}  // namespace
}  // namespace axial::test
