// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/robust_similarity.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

namespace axial {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// Cameras of a survey, `flat` times as high as wide, and their positions after a similarity.
struct Survey {
  Matrix3Xd cameras, positions;
};

class Noise {
 public:
  explicit Noise(unsigned seed) : engine_(seed) {}

  double normal() { return normal_(engine_); }
  Vector3d vector() { return {normal(), normal(), normal()}; }

  Survey survey(Eigen::Index count, double flat, double noise) {
    Survey survey{Matrix3Xd(3, count), Matrix3Xd(3, count)};
    const Eigen::Matrix3d turn =
        Eigen::Quaterniond(normal(), normal(), normal(), normal()).normalized().toRotationMatrix();
    for (Eigen::Index i = 0; i < count; ++i) {
      survey.cameras.col(i) = vector().cwiseProduct(Vector3d(1, 0.6, flat));
      survey.positions.col(i) =
          3 * (turn * survey.cameras.col(i)) + Vector3d(10, 20, 30) + noise * vector();
    }
    return survey;
  }

 private:
  std::mt19937 engine_;
  std::normal_distribution<double> normal_;
};

Matrix3Xd without(const Matrix3Xd& points, const std::vector<std::size_t>& left_out) {
  Matrix3Xd rest(3, points.cols() - static_cast<Eigen::Index>(left_out.size()));
  for (Eigen::Index i = 0, k = 0; i < points.cols(); ++i)
    if (std::ranges::find(left_out, static_cast<std::size_t>(i)) == left_out.end())
      rest.col(k++) = points.col(i);
  return rest;
}

// Noise of any size makes no outlier and changes no bit.
TEST(RobustSimilarity, IsTheBestOneWithoutOutliers) {
  for (unsigned seed = 0; seed < 24; ++seed) {
    Noise noise_of(seed);
    // More than 24 points are tried by random triples.
    const Eigen::Index count = seed < 2 ? 40 : 3 + seed % 10;
    const double flat = std::array{1.0, 0.05, 0.0}[seed % 3];
    const double noise = std::array{0.0, 1e-4, 0.01, 0.5}[seed % 4];
    const Survey survey = noise_of.survey(count, flat, noise);
    for (const bool with_scale : {true, false}) {
      const RobustSimilarity fit = robust_similarity(survey.cameras, survey.positions, with_scale);
      EXPECT_THAT(fit.outliers, IsEmpty()) << seed << ": " << count << " points, noise " << noise;
      EXPECT_EQ(fit.similarity.matrix(),
                best_similarity(survey.cameras, survey.positions, with_scale).matrix());
      EXPECT_FALSE(mirrored_fit(survey.cameras, survey.positions, with_scale).better) << seed;
    }
  }
}

TEST(RobustSimilarity, LeavesOutWrongPositions) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    Noise noise_of(seed);
    const Eigen::Index count = seed < 2 ? 30 : 5 + seed % 12;
    Survey survey = noise_of.survey(count, seed % 2 ? 0.3 : 0, 0.01);
    // A wrong position in five, up to three.
    std::vector<std::size_t> wrong;
    for (Eigen::Index i = 0; i < std::min<Eigen::Index>(3, count / 5); ++i) {
      wrong.push_back(static_cast<std::size_t>(2 * i + 1));
      survey.positions.col(2 * i + 1) += 50 * noise_of.vector().normalized();
    }
    const RobustSimilarity fit = robust_similarity(survey.cameras, survey.positions);
    EXPECT_EQ(fit.outliers, wrong) << seed << ": " << count;
    EXPECT_EQ(
        fit.similarity.matrix(),
        best_similarity(without(survey.cameras, wrong), without(survey.positions, wrong)).matrix());
    EXPECT_LT(fit.rms, 0.04);
    EXPECT_NEAR(fit.distances[1], 50, 1);
  }
}

// The last camera alone determines the turn about the line of the others.
TEST(RobustSimilarity, KeepsACameraWithoutWhichNothingIsDetermined) {
  Noise noise_of(1);
  Survey survey = noise_of.survey(8, 0, 0);
  for (Eigen::Index i = 0; i < 7; ++i) survey.cameras.col(i) = Vector3d(0.1 * double(i), 0, 0);
  survey.cameras.col(7) = Vector3d(0, 1, 0);
  survey.positions = survey.cameras;
  for (Eigen::Index i = 0; i < 7; ++i) survey.positions.col(i) += 1e-5 * noise_of.vector();
  survey.positions.col(7) = Vector3d(0, 0, 1);
  EXPECT_THAT(robust_similarity(survey.cameras, survey.positions).outliers, IsEmpty());
}

// The last camera is off the line of the others, and its position is wrong.
TEST(RobustSimilarity, FindsTheWrongPositionThatIsOffTheLineOfTheOthers) {
  for (unsigned seed = 0; seed < 8; ++seed) {
    Noise noise_of(seed);
    Survey survey = noise_of.survey(10, 0, 0);
    for (Eigen::Index i = 0; i < 9; ++i) survey.cameras.col(i) = Vector3d(double(i), 0, 0);
    survey.cameras.col(9) = Vector3d(4, 1, 0);
    survey.positions = 3 * survey.cameras;
    for (Eigen::Index i = 0; i < 10; ++i) survey.positions.col(i) += 1e-3 * noise_of.vector();
    const RobustSimilarity fits = robust_similarity(survey.cameras, survey.positions);
    EXPECT_FALSE(fits.off_line) << seed;
    survey.positions.col(9) += 5 * noise_of.vector().normalized();
    const RobustSimilarity fit = robust_similarity(survey.cameras, survey.positions);
    EXPECT_EQ(fit.off_line, 9u) << seed;
    EXPECT_THAT(fit.outliers, IsEmpty()) << seed;
    EXPECT_THAT(off_line_sentence(fit, "a.jpg"),
                HasSubstr("the position of a.jpg does not fit the 9 others that are used"));
  }
}

TEST(RobustSimilarity, TellsThePhotographs) {
  Survey survey = Noise(3).survey(8, 0.5, 0.001);
  survey.positions.col(2).x() += 50;
  const std::vector<std::string> names{"0", "1", "two.jpg", "3", "4", "5", "6", "7"};
  EXPECT_THAT(outlier_lines(robust_similarity(survey.cameras, survey.positions), names),
              ElementsAre(HasSubstr(
                  "the position of two.jpg is 50 m from where the 7 positions that fit together "
                  "put it, and is not used")));
}

TEST(MirroredFit, IsBetterForALeftHandedFrame) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    Survey survey = Noise(seed).survey(5 + seed % 8, 0.2, 0.001);
    survey.positions.row(seed % 3) *= -1;
    if (seed % 2) survey.positions.col(0) += Vector3d(0, 20, 0);  // and one wrong position
    const MirroredFit fit = mirrored_fit(survey.cameras, survey.positions);
    EXPECT_TRUE(fit.better) << seed << ": " << fit.rms << " and " << fit.mirrored_rms;
    EXPECT_FALSE(fit.alike);
  }
}

TEST(MirroredFit, OfPlanesIsAlike) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    Survey survey = Noise(seed).survey(4 + seed % 8, 0, 0.01);
    if (seed % 2) survey.positions.row(2) *= -1;
    const MirroredFit fit = mirrored_fit(survey.cameras, survey.positions);
    EXPECT_FALSE(fit.better) << seed;
    EXPECT_TRUE(fit.alike) << seed << ": " << fit.rms << " and " << fit.mirrored_rms;
  }
}

}  // namespace
}  // namespace axial
