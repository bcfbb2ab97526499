// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/alignment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "evaluate/shapes.h"
#include "support/error_of.h"

namespace axial::evaluate {
namespace {

Similarity random_similarity(std::mt19937& random) {
  std::uniform_real_distribution<double> log_scale(-2, 2);
  const double scale = std::exp(log_scale(random));
  const Eigen::Matrix3d rotation = random_rotation(random);
  return {scale, rotation, random_vector(random, 10)};
}

TEST(FitSimilarity, RecoversExactOnes) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    std::mt19937 random(seed);
    const Similarity truth = random_similarity(random);
    const std::size_t count = 3 + seed % 5;
    std::vector<Eigen::Vector3d> source, target;
    for (std::size_t i = 0; i < count; ++i) {
      source.push_back(random_vector(random, 2));
      if (seed % 2) source.back().z() = 1;  // coplanar centres, as in a survey at one height
      target.push_back(truth(source.back()));
    }
    const Similarity found = fit_similarity(source, target);
    EXPECT_NEAR(found.scale / truth.scale, 1, 1e-10) << seed;
    EXPECT_LT((found.rotation - truth.rotation).norm(), 1e-8) << seed;
    EXPECT_LT((found.translation - truth.translation).norm(), 1e-8 * (1 + truth.scale)) << seed;
    EXPECT_NEAR(found.rotation.determinant(), 1, 1e-10);
  }
}

TEST(FitSimilarity, IsTheBestInTheLeastSquaresSense) {
  std::mt19937 random(4);
  const Similarity truth = random_similarity(random);
  std::vector<Eigen::Vector3d> source, target;
  for (int i = 0; i < 12; ++i) {
    source.push_back(random_vector(random, 1));
    target.push_back(truth(source.back()) + random_vector(random, 0.05));
  }
  const auto cost = [&](const Similarity& s) {
    double sum = 0;
    for (std::size_t i = 0; i < source.size(); ++i) sum += (s(source[i]) - target[i]).squaredNorm();
    return sum;
  };
  const Similarity best = fit_similarity(source, target);
  for (int trial = 0; trial < 100; ++trial) {  // every small change makes the fit worse
    const Eigen::Vector3d turn = random_vector(random, 1e-3);
    Similarity other = best;
    other.scale *= 1 + random_vector(random, 1e-3).x();
    other.rotation =
        Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix() * other.rotation;
    other.translation += random_vector(random, 1e-3);
    EXPECT_GT(cost(other), cost(best));
  }
}

TEST(FitSimilarity, RefusesTooFewAndCollinear) {
  const std::vector<Eigen::Vector3d> two{{0, 0, 0}, {1, 0, 0}};
  EXPECT_THROW(fit_similarity(two, two), Error);
  const std::vector<Eigen::Vector3d> line{{0, 0, 0}, {1, 2, 3}, {2, 4, 6}, {-1, -2, -3}};
  const std::vector<Eigen::Vector3d> spread{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  EXPECT_THROW(fit_similarity(line, spread), Error);
  EXPECT_THROW(fit_similarity(spread, line), Error);
  const std::vector<Eigen::Vector3d> same(4, {1, 2, 3});
  EXPECT_THROW(fit_similarity(same, spread), Error);
}

TEST(FitSimilarity, RefusesAWrongPositionOffTheLineOfTheOthers) {
  std::vector<Eigen::Vector3d> source, target;
  for (int i = 0; i < 6; ++i) source.emplace_back(i, i == 2 ? 1 : 0, 1e-3 * (i % 2));
  target = source;
  EXPECT_NO_THROW(fit_similarity(source, target));
  target[2] += Eigen::Vector3d(30, 20, 0);
  EXPECT_THAT(test::error_of([&] { fit_similarity(source, target); }),
              testing::HasSubstr("the position of number 3 does not fit the 5 others"));
  const std::vector<std::string> names{"a", "b", "c.jpg", "d", "e", "f"};
  EXPECT_THAT(test::error_of([&] { fit_positions(source, target, true, names); }),
              testing::HasSubstr("the position of c.jpg does not fit"));
}

TEST(Similarity, ComposesAsItsMatrix) {
  std::mt19937 random(8);
  const Similarity a = random_similarity(random), b = random_similarity(random);
  EXPECT_LT((a.after(b).matrix() - a.matrix() * b.matrix()).norm(),
            1e-12 * a.matrix().norm() * b.matrix().norm());
}

io::ColmapModel model_of(const std::vector<Pose>& poses) {
  io::ColmapModel model;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    io::ColmapImage image;
    image.id = static_cast<std::uint32_t>(i + 1);
    image.name = fmt::format("{:04}.jpg", i);
    image.pose = poses[i];
    model.images.push_back(image);
  }
  return model;
}

TEST(AlignCentres, MatchesImagesByNameAndKeepsReprojections) {
  std::mt19937 random(11);
  std::vector<Pose> poses;
  for (int i = 0; i < 6; ++i) poses.push_back({random_rotation(random), random_vector(random, 2)});
  io::ColmapModel reference = model_of(poses);
  io::ColmapModel model = reference;
  model.points.push_back({1, Eigen::Vector3d(0.3, 0.2, 4), {}, 0, {}});
  const Eigen::Vector3d point = model.points[0].position;
  const Similarity away = random_similarity(random);
  apply(away, model);
  // Another order, and an image that only one model has.
  std::reverse(model.images.begin(), model.images.end());
  model.images.front().name = "only_here.jpg";
  const Eigen::Matrix3d rotation = model.images.back().pose.rotation;
  model.images.back().pose.rotation =
      Eigen::AngleAxisd(0.02, Eigen::Vector3d(1, 2, 2) / 3) * rotation;
  EXPECT_NEAR(align_centres(model, reference).turns.back(), 0.02, 1e-9);
  model.images.back().pose.rotation = rotation;

  const CentreAlignment alignment = align_centres(model, reference);
  EXPECT_EQ(alignment.names.size(), 5u);
  EXPECT_LT(alignment.rms, 1e-10);
  EXPECT_LT(*std::max_element(alignment.turns.begin(), alignment.turns.end()), 1e-9);
  apply(alignment.similarity, model);
  EXPECT_LT((model.points[0].position - point).norm(), 1e-9);
  for (const io::ColmapImage& image : model.images) {
    const Pose& truth = poses[image.id - 1];
    EXPECT_LT((image.pose.centre - truth.centre).norm(), 1e-9);
    EXPECT_LT((image.pose.rotation - truth.rotation).norm(), 1e-9);
  }
}

TEST(AlignCentres, ReportsResiduals) {
  std::vector<Pose> poses(4);
  poses[1].centre = {1, 0, 0};
  poses[2].centre = {0, 1, 0};
  poses[3].centre = {1, 1, 0};
  const io::ColmapModel reference = model_of(poses);
  // Centres alternate up and down by 0.1. No similarity can remove this, and the identity is the
  // best one.
  poses[0].centre.z() = poses[3].centre.z() = 0.1;
  poses[1].centre.z() = poses[2].centre.z() = -0.1;
  const CentreAlignment alignment = align_centres(model_of(poses), reference);
  EXPECT_NEAR(alignment.rms, 0.1, 0.005);
}

TEST(AlignCentres, LeavesOutACentreThatDoesNotFit) {
  std::mt19937 random(5);
  std::vector<Pose> poses;
  for (int i = 0; i < 8; ++i) poses.push_back({random_rotation(random), random_vector(random, 2)});
  io::ColmapModel reference = model_of(poses);
  const io::ColmapModel model = reference;
  reference.images[3].pose.centre.x() += 50;
  const CentreAlignment alignment = align_centres(model, reference);
  EXPECT_THAT(alignment.outliers, ::testing::ElementsAre(::testing::HasSubstr("0003.jpg is 50 m")));
  EXPECT_LT(alignment.rms_of_fitting, 1e-9);
  EXPECT_LT(alignment.largest, 1e-9);
  EXPECT_NEAR(alignment.residuals[3], 50, 1e-9);
  EXPECT_NEAR(alignment.similarity.scale, 1, 1e-9);
}

// Heights that count downwards, as depths do.
TEST(FitSimilarity, RefusesMirrorImages) {
  std::mt19937 random(6);
  std::vector<Eigen::Vector3d> source, target;
  for (int i = 0; i < 8; ++i) {
    source.push_back(random_vector(random, 2));
    target.emplace_back(source.back().x(), source.back().y(), -source.back().z());
  }
  EXPECT_THROW(fit_similarity(source, target), Error);
}

TEST(AlignCentres, NeedsThreeCommonImages) {
  std::vector<Pose> poses(3);
  poses[1].centre = {1, 0, 0};
  poses[2].centre = {0, 1, 0};
  const io::ColmapModel reference = model_of(poses);
  io::ColmapModel model = reference;
  model.images[1].name = "other.jpg";
  EXPECT_THROW(align_centres(model, reference), Error);
}

TEST(Apply, MovesCloudsAndTurnsNormals) {
  PointCloud cloud;
  cloud.positions = {{1, 0, 0}};
  cloud.normals = {{0, 1, 0}};
  Similarity s{
      2, Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix(), {0, 0, 5}};
  apply(s, cloud);
  EXPECT_LT((cloud.positions[0] - Eigen::Vector3f(0, 2, 5)).norm(), 1e-6f);
  EXPECT_LT((cloud.normals[0] - Eigen::Vector3f(-1, 0, 0)).norm(), 1e-6f);
}

TEST(MatrixText, IsFourRowsOfFour) {
  Similarity s;
  s.scale = 2;
  s.translation = {1, 2, 3};
  EXPECT_EQ(matrix_text(s), "2 0 0 1\n0 2 0 2\n0 0 2 3\n0 0 0 1\n");
}

}  // namespace
}  // namespace axial::evaluate
