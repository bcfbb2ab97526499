// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/target_registration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <random>

#include "support/error_of.h"
#include "two_surveys.h"

namespace axial::test {
namespace {

using namespace compare;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

// Plates on a reef of 4 m x 3 m, at different heights.
Eigen::Matrix3Xd plates(Eigen::Index count) {
  Eigen::Matrix3Xd all(3, 6);
  all << 0.2, 3.7, 3.9, 0.1, 2.1, 1.2,  //
      0.1, 0.3, 2.8, 2.6, 1.5, 2.2,     //
      0.0, 0.3, -0.1, 0.2, 0.5, -0.3;
  return all.leftCols(count);
}

// Between two frames that have nothing to do with each other.
Similarity some_motion() {
  Similarity motion;
  motion.rotation =
      Eigen::AngleAxisd(1.3, Eigen::Vector3d(0.3, -0.5, 0.8).normalized()).toRotationMatrix();
  motion.translation = {12, -7, 3};
  return motion;
}

// Independent errors of plates: the first ones are known best, and heights worst.
Eigen::MatrixXd independent(Eigen::Index count, double sigma) {
  Eigen::VectorXd sigmas(3 * count);
  for (Eigen::Index i = 0; i < count; ++i)
    sigmas.segment<3>(3 * i) =
        sigma * (1 + 0.3 * static_cast<double>(i)) * Eigen::Vector3d(1, 1.2, 1.8);
  return sigmas.cwiseAbs2().asDiagonal();
}

// The derivatives of places by a motion about the origin.
Eigen::MatrixXd motion_of_all(const Eigen::Matrix3Xd& places) {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(places.size(), 6);
  for (Eigen::Index i = 0; i < places.cols(); ++i)
    for (int k = 0; k < 3; ++k) {
      columns.block<3, 1>(3 * i, k) = Eigen::Vector3d::Unit(k).cross(places.col(i));
      columns(3 * i + k, 3 + k) = 1;
    }
  return columns;
}

// The covariance of a frame whose origin and axes are known to 0.5 m and 0.05.
Eigen::MatrixXd of_frame(const Eigen::Matrix3Xd& places) {
  Vector6d sigma;
  sigma << 0.05, 0.04, 0.03, 0.5, 0.3, 0.4;
  const Eigen::MatrixXd columns = motion_of_all(places) * sigma.asDiagonal();
  return columns * columns.transpose();
}

class Draws {
 public:
  explicit Draws(std::uint64_t seed) : random_(seed) {}

  // Errors of all places.
  Eigen::Matrix3Xd errors(const Eigen::MatrixXd& covariance) {
    std::normal_distribution<double> normal;
    Eigen::VectorXd draw(covariance.rows());
    for (double& value : draw) value = normal(random_);
    const Eigen::MatrixXd factor = Eigen::LLT<Eigen::MatrixXd>(covariance).matrixL();
    const Eigen::VectorXd errors = factor * draw;
    return Eigen::Map<const Eigen::Matrix3Xd>(errors.data(), 3, errors.size() / 3);
  }

 private:
  std::mt19937_64 random_;
};

// Two surveys of the plates, whose errors have standard deviations of 1 mm and 2 mm and more.
CommonTargets surveyed_plates(Eigen::Index count, std::uint64_t seed) {
  Draws draws(seed);
  const Eigen::Matrix3Xd truth = plates(count);
  const Similarity motion = some_motion();
  CommonTargets targets;
  for (Eigen::Index i = 0; i < count; ++i)
    targets.labels.push_back("target " + std::to_string(i + 1));
  targets.covariance_before = independent(count, 0.001);
  targets.covariance_after = independent(count, 0.002);
  targets.before = truth + draws.errors(targets.covariance_before);
  targets.after = (motion.rotation.transpose() * (truth.colwise() - motion.translation)) +
                  draws.errors(targets.covariance_after);
  return targets;
}

// What is left of the true motion: rotation vector and translation about the centre.
Vector6d error_of(const TargetRegistration& found) {
  const Similarity truth = some_motion();
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(found.motion.rotation * truth.rotation.transpose()));
  const Eigen::Vector3d later = truth.rotation.transpose() * (found.centre - truth.translation);
  Vector6d error;
  error << turn.angle() * turn.axis(), found.motion(later) - found.centre;
  return error;
}

TEST(TargetRegistration, FindsTheMotionWithItsUncertainty) {
  constexpr int kRuns = 200;
  for (const Eigen::Index count : {3, 4, 6}) {
    double squares = 0, residuals = 0;
    int within = 0;
    for (std::uint64_t run = 0; run < kRuns; ++run) {
      const TargetRegistration found = register_targets(surveyed_plates(count, run));
      const Vector6d error = error_of(found);
      squares += error.dot(found.covariance.ldlt().solve(error)) / 6;
      residuals += found.chi_squared / found.freedom;
      within += (error.array().abs() < 3 * found.covariance.diagonal().array().sqrt()).all();
      EXPECT_EQ(found.freedom, 3 * count - 6);
    }
    // Three plates do not show how well their heights are known (register_targets()). The means of
    // the squares have standard deviations of 0.04 and at most 0.06.
    EXPECT_NEAR(squares / kRuns, 1, count == 3 ? 0.4 : 0.15) << count;
    EXPECT_NEAR(residuals / kRuns, 1, 0.2) << count;
    EXPECT_GE(within, 0.96 * kRuns) << count;
  }
}

TEST(TargetRegistration, FramesThatAreKnownBadlyDoNotMatter) {
  for (const Eigen::Index count : {3, 4, 6}) {
    CommonTargets targets = surveyed_plates(count, 7);
    const TargetRegistration plain = register_targets(targets);
    targets.covariance_before += of_frame(targets.before);
    targets.covariance_after += of_frame(targets.after);
    const TargetRegistration found = register_targets(targets);
    EXPECT_LT((found.motion.matrix() - plain.motion.matrix()).norm(), 1e-5) << count;
    EXPECT_NEAR(found.chi_squared, plain.chi_squared, 1e-3 * plain.chi_squared + 1e-3) << count;
    const Vector6d ratio =
        found.covariance.diagonal().cwiseQuotient(plain.covariance.diagonal()).cwiseSqrt();
    // The variances along the normal of three plates are not known, and become larger.
    EXPECT_GT(ratio.minCoeff(), 0.99) << count;
    EXPECT_LT(ratio.maxCoeff(), count == 3 ? 2.5 : 1.01) << count;
  }
}

// The mean of the plates is the origin of the frame: the covariances have no rigid motion.
TEST(TargetRegistration, AFrameOfThePlatesThemselvesGivesTheSameUncertainty) {
  CommonTargets targets = surveyed_plates(6, 8);
  targets.covariance_before = Eigen::MatrixXd::Identity(18, 18) * 1e-6;
  targets.covariance_after = targets.covariance_before;
  const TargetRegistration plain = register_targets(targets);
  for (const bool before : {true, false}) {
    Eigen::MatrixXd& covariance = before ? targets.covariance_before : targets.covariance_after;
    const Eigen::MatrixXd columns = motion_of_all(before ? targets.before : targets.after);
    const Eigen::MatrixXd out =
        Eigen::MatrixXd::Identity(18, 18) -
        columns * (columns.transpose() * columns).ldlt().solve(columns.transpose());
    covariance = (out * covariance * out.transpose()).eval();
  }
  const TargetRegistration found = register_targets(targets);
  EXPECT_LT((found.covariance - plain.covariance).norm(), 0.02 * plain.covariance.norm());
  EXPECT_LT((found.motion.matrix() - plain.motion.matrix()).norm(), 1e-4);
}

TEST(TargetRegistration, NamesThePlateThatMoved) {
  for (Eigen::Index moved = 0; moved < 5; ++moved)
    for (std::uint64_t run = 0; run < 20; ++run) {
      CommonTargets targets = surveyed_plates(5, 100 + run);
      targets.after.col(moved) += Eigen::Vector3d(0.05, -0.03, 0.02);
      const TargetRegistration found = register_targets(targets);
      EXPECT_THAT(found.moved, ElementsAre(static_cast<std::size_t>(moved))) << run;
      EXPECT_THAT(found.used, SizeIs(4));
      EXPECT_THAT(found.doubtful, IsEmpty());
      EXPECT_NEAR(found.residuals.col(moved).norm(), 0.062, 0.03);
      EXPECT_LT(error_of(found).tail<3>().norm(), 0.01);
    }
}

TEST(TargetRegistration, SaysThatPlatesDisagree) {
  // The only distance out of their plane that four plates on level ground show is the same for all.
  CommonTargets targets = surveyed_plates(4, 3);
  targets.before.row(2).setZero();
  const Similarity motion = some_motion();
  targets.after = motion.rotation.transpose() * (targets.before.colwise() - motion.translation);
  targets.after.col(1) += motion.rotation.transpose() * Eigen::Vector3d(0, 0, 0.1);
  const TargetRegistration level = register_targets(targets);
  EXPECT_THAT(level.doubtful, SizeIs(4));
  EXPECT_THAT(level.moved, IsEmpty());
  EXPECT_FALSE(level.agrees);
  // Three plates do not show which one moved.
  targets = surveyed_plates(3, 3);
  const TargetRegistration plain = register_targets(targets);
  targets.after.col(1) += Eigen::Vector3d(0.1, -0.1, 0.1);
  const TargetRegistration three = register_targets(targets);
  EXPECT_TRUE(plain.agrees);
  EXPECT_FALSE(three.agrees);
  EXPECT_THAT(three.moved, IsEmpty());
  EXPECT_GT(three.covariance.norm(), 20 * plain.covariance.norm());
}

// Without the plate beside the line, the others determine no rotation about it.
TEST(TargetRegistration, KeepsAPlateThatAloneDeterminesARotation) {
  CommonTargets targets = surveyed_plates(4, 5);
  for (Eigen::Matrix3Xd* places : {&targets.before, &targets.after})
    places->col(2) = 0.4 * places->col(0) + 0.6 * places->col(1);
  EXPECT_THAT(register_targets(targets).moved, IsEmpty());
  const Eigen::Vector3d along = targets.after.col(1) - targets.after.col(0);
  targets.after.col(2) += 0.1 * along.normalized();
  const TargetRegistration found = register_targets(targets);
  EXPECT_THAT(found.moved, ElementsAre(2u));
  EXPECT_LT(error_of(found).tail<3>().norm(), 0.01);
}

TEST(TargetRegistration, StatesTheDifferenceOfScales) {
  constexpr int kRuns = 100;
  double squares = 0;
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    CommonTargets targets = surveyed_plates(6, 1000 + run);
    targets.before *= 1.002;
    const TargetRegistration found = register_targets(targets);
    const double deviation = (found.scale - 1.002) / found.scale_sigma;
    squares += deviation * deviation;
    EXPECT_EQ(found.motion.scale, 1);
    EXPECT_LT(found.scale_sigma, 0.001);
  }
  EXPECT_NEAR(squares / kRuns, 1, 0.45);  // three standard deviations
}

TEST(TargetRegistration, PlatesWithoutErrorsAreAligned) {
  CommonTargets targets = surveyed_plates(3, 1);
  const Similarity motion = some_motion();
  targets.after = motion.rotation.transpose() * (targets.before.colwise() - motion.translation);
  targets.covariance_before.setZero();
  targets.covariance_after.setZero();
  const TargetRegistration found = register_targets(targets);
  EXPECT_LT((found.motion.matrix() - motion.matrix()).norm(), 1e-9);
  EXPECT_TRUE(found.covariance.allFinite());
}

TEST(TargetRegistration, RefusesTargetsThatDoNotDetermineTheMotion) {
  const auto refused = [](const CommonTargets& targets) {
    return test::error_of([&] { register_targets(targets); });
  };
  EXPECT_THAT(refused(surveyed_plates(2, 1)), HasSubstr("2 targets are in both surveys, but"));
  EXPECT_THAT(refused({}), HasSubstr("0 targets are in both surveys, but"));
  CommonTargets line = surveyed_plates(3, 1);
  for (Eigen::Matrix3Xd* places : {&line.before, &line.after})
    places->col(2) = 0.4 * places->col(0) + 0.6 * places->col(1);
  EXPECT_THAT(refused(line), HasSubstr("the targets target 1, target 2, target 3 lie on a line"));
  CommonTargets infinite = surveyed_plates(3, 1);
  infinite.covariance_after(2, 2) = std::numeric_limits<double>::infinity();
  EXPECT_THAT(refused(infinite), HasSubstr("not finite"));
}

TEST(TargetRegistration, OnAMapIsTheSameMotion) {
  const CommonTargets targets = surveyed_plates(5, 1);
  const TargetRegistration found = register_targets(targets);
  const LocalFrame mesh_frame{{10, -20, 30}};
  const map::MapFrame frame = map::frame_with_up({0.2, -0.4, 0.7}, mesh_frame);
  const Registration registration = on_map(found, frame, mesh_frame);
  const auto on = [&](const Eigen::Vector3d& world) {
    return frame.to_map(mesh_frame.to_local(world));
  };
  const Eigen::Vector3d x = targets.after.col(2);
  const RigidMotion& motion = registration.motion;
  EXPECT_LT((motion.rotation * (on(x) - motion.centre) + motion.centre + motion.translation -
             on(found.motion(x)))
                .norm(),
            1e-10);
  EXPECT_NEAR(registration.covariance.trace(), found.covariance.trace(), 1e-12);
  EXPECT_EQ(registration.share_used, 1);
  // The height is uncertain by the translation along the upward direction.
  const Eigen::Vector3d up = frame.axes.row(2).transpose();
  EXPECT_NEAR(registration.height_variance(motion.centre, {0, 0}),
              up.dot(found.covariance.bottomRightCorner<3, 3>() * up), 1e-12);
}

}  // namespace
}  // namespace axial::test
