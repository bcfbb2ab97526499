// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/cloud_evaluation.h"

#include <gtest/gtest.h>

#include <limits>

#include "base/error.h"
#include "evaluate/shapes.h"
#include "geometry/sampling.h"

namespace axial::evaluate {
namespace {

TEST(EvaluateCloud, PointsAtAKnownOffsetFromASphere) {
  const Mesh truth = sphere(1, 300);
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 3000; ++i) {  // a third at 1 mm inside, two thirds at 4 mm outside
    const double x = normal(random), y = normal(random);
    const Eigen::Vector3d direction = Eigen::Vector3d(x, y, normal(random)).normalized();
    points.push_back((direction * (i % 3 == 0 ? 0.999 : 1.004)).cast<float>());
  }
  CloudOptions options;
  options.samples = 20000;
  options.tolerances = {0.002};
  const CloudEvaluation e = evaluate_cloud(points, truth, geometry::Surface(truth), {}, options);
  const double facet = 6e-5;  // distance of the facets from the sphere
  EXPECT_NEAR(e.accuracy.mean, 0.003, facet);
  EXPECT_NEAR(e.accuracy.median, 0.004, facet);
  EXPECT_NEAR(e.accuracy.rms, std::sqrt(11e-6), facet);
  EXPECT_NEAR(e.accuracy.variance, 2e-6, 2 * 0.003 * facet);
  EXPECT_NEAR(e.accuracy.max, 0.004, facet);
  EXPECT_NEAR(e.scores[0].precision, 1 / 3.0, 1e-12);
  EXPECT_EQ(e.distances.size(), points.size());
  EXPECT_EQ(e.places.size(), 20000u);
  EXPECT_EQ(e.views, 0u);
}

TEST(EvaluateCloud, HalfCoveredPlaneIsHalfComplete) {
  const Mesh truth = height_field(100, 2, [](double, double) { return 0.0; });
  std::vector<Eigen::Vector3f> points;  // a grid over x < 0, 1 cm apart
  for (int i = 0; i < 100; ++i)
    for (int j = 0; j < 200; ++j)
      points.emplace_back(-0.005f - 0.01f * static_cast<float>(i),
                          -0.995f + 0.01f * static_cast<float>(j), 0.0f);
  CloudOptions options;
  options.samples = 10000;
  options.tolerances = {0.02, 3};
  const CloudEvaluation e = evaluate_cloud(points, truth, geometry::Surface(truth), {}, options);
  EXPECT_LT(e.accuracy.max, 1e-9);
  // About one sample falls into each of the truth's cells of 2 cm, so only the hundred cells along
  // the border are random: a standard error of 0.0005. Covered are x < 0 and the strip within reach
  // of the last column of points. Its reach is 2 cm, and the column is half a step from x = 0, so
  // the strip is 1.5 cm wide, less the corners between the rows.
  EXPECT_NEAR(e.scores[0].recall, 0.5 + 0.0145 / 2, 0.003);
  EXPECT_DOUBLE_EQ(e.scores[1].recall, 1);
  EXPECT_DOUBLE_EQ(e.scores[0].f_score, 2 * e.scores[0].recall / (1 + e.scores[0].recall));
}

TEST(EvaluateCloud, NearestPointsAgreeWithBruteForce) {
  std::mt19937 random(9);
  std::vector<Eigen::Vector3f> points, queries;
  for (int i = 0; i < 500; ++i) points.push_back(random_vector(random, 1).cast<float>());
  for (int i = 0; i < 200; ++i) queries.push_back(random_vector(random, 2).cast<float>());
  const auto distances = nearest_point_distances(queries, points);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    float best = std::numeric_limits<float>::infinity();
    for (const auto& p : points) best = std::min(best, (p - queries[i]).norm());
    EXPECT_NEAR(distances[i], best, 1e-6f);  // float arithmetic in two different orders
  }
}

TEST(EvaluateMesh, AMeshAgainstItselfIsPerfect) {
  const Mesh truth = height_field(30, 2, ripples);
  CloudOptions options;
  options.samples = 5000;
  options.tolerances = {0.001};
  std::vector<Eigen::Vector3f> sampled;
  const CloudEvaluation e =
      evaluate_mesh(truth, truth, geometry::Surface(truth), {}, options, sampled);
  EXPECT_EQ(sampled.size(), 5000u);
  // Samples are rounded to float. Their distance from their triangle is far below their spacing.
  EXPECT_LT(e.accuracy.max, 1e-6);
  EXPECT_LT(e.completeness.max, 1e-6);
  EXPECT_DOUBLE_EQ(e.scores[0].f_score, 1);
}

TEST(EvaluateCloud, RefusesWhatCannotBeEvaluated) {
  const Mesh truth = flat_square(2, 0);
  const geometry::Surface surface(truth);
  const std::vector<Eigen::Vector3f> one{{0, 0, 0}};
  const CloudOptions options;
  EXPECT_THROW(evaluate_cloud({}, truth, surface, {}, options), Error);
  const std::vector<Eigen::Vector3f> nan{{0, std::numeric_limits<float>::quiet_NaN(), 0}};
  EXPECT_THROW(evaluate_cloud(nan, truth, surface, {}, options), Error);
  CloudOptions bad = options;
  bad.tolerances = {0.01, -1};
  EXPECT_THROW(evaluate_cloud(one, truth, surface, {}, bad), Error);
  bad.tolerances.clear();
  EXPECT_THROW(evaluate_cloud(one, truth, surface, {}, bad), Error);
  bad = options;
  bad.samples = 0;
  EXPECT_THROW(evaluate_cloud(one, truth, surface, {}, bad), Error);
  View away;  // looks the other way, so no sample is seen
  away.camera = {100, 100, {100, 100, 50, 50}, {}};
  away.pose.centre = {0, 0, 1};
  const std::vector<View> views{away, away};
  EXPECT_THROW(evaluate_cloud(one, truth, surface, views, options), Error);
}

}  // namespace
}  // namespace axial::evaluate
