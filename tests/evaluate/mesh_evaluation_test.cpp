// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/mesh_evaluation.h"

#include <gtest/gtest.h>

#include "evaluate/shapes.h"
#include "worlds/ports.h"

namespace axial::evaluate {
namespace {

MeshEvaluation evaluated(const Mesh& mesh, const Mesh& truth, std::span<const View> views,
                         const CloudOptions& options) {
  const geometry::Surface surface(truth);
  std::vector<Eigen::Vector3f> positions;
  std::vector<std::uint32_t> faces;
  const CloudEvaluation whole =
      evaluate_mesh(mesh, truth, surface, views, options, positions, &faces);
  return evaluate_mesh_parts(mesh, {positions, faces}, surface, views, options, whole);
}

CloudOptions with_samples(std::size_t samples) {
  CloudOptions options;
  options.samples = samples;
  options.tolerances = {0.001};
  return options;
}

// A camera 1 m above (x, 0, 0) that looks down at 1 m x 2 m of ground.
View above(double x) {
  return {test::camera_above({x, 0, 1}, 100, 200, 100)};
}

TEST(EvaluateMeshParts, NormalsOfARoofHaveTheAngleOfItsSlope) {
  const double slope = std::tan(15 * std::numbers::pi / 180);
  const Mesh roof = height_field(2, 2, [&](double x, double) { return -slope * std::abs(x); });
  const MeshEvaluation e = evaluated(roof, flat_square(4, 0), {}, with_samples(1000));
  EXPECT_EQ(e.normals.count, 1000u);
  EXPECT_NEAR(e.normals.median, 15, 1e-4);  // float coordinates
  EXPECT_EQ(e.normals.within, (std::array<double, 3>{0, 1, 1}));
  EXPECT_FALSE(e.seen);
  EXPECT_FALSE(e.unseen);
}

TEST(EvaluateMeshParts, AFlippedFaceIsWrongByAHalfTurn) {
  Mesh mesh = flat_square(2, 0);
  std::swap(mesh.faces[0][0], mesh.faces[0][1]);  // half of the area
  const MeshEvaluation e = evaluated(mesh, flat_square(2, 0), {}, with_samples(1000));
  for (const double share : e.normals.within) EXPECT_NEAR(share, 0.5, 0.001);
  EXPECT_EQ(e.topology.inconsistent_edges, 1u);
}

// The cameras see x in [-1, 0], [-0.5, 0.5] and [-0.5, 0.5]; the ground is 4 m x 2 m. So of x in
// [-2, 2] one view sees [-1, -0.5], two or more [-0.5, 0.5], no view the rest.
TEST(EvaluateMeshParts, SharesOfAreaByWhatTheViewsSee) {
  Mesh truth = height_field(40, 4, [](double, double) { return 0.0; });
  for (auto& x : truth.vertices) x.y() /= 2;
  Mesh mesh = truth;  // 0.1 mm below the truth, which must not hide it
  for (auto& x : mesh.vertices) x.z() -= 1e-4f;
  const std::vector<View> views{above(-0.5), above(0), above(0)};
  const std::size_t samples = 40000;
  MeshEvaluation e = evaluated(mesh, truth, views, with_samples(samples));
  // A sample lies at random within its piece, and the borders cut a few hundred pieces.
  EXPECT_NEAR(e.unseen->no_view, 5.0 / 8, 0.003);
  EXPECT_NEAR(e.unseen->few_views, 1.0 / 8, 0.003);
  EXPECT_EQ(e.unseen->far, 0);
  EXPECT_NEAR(e.seen->share, 2.0 / 8, 0.003);
  EXPECT_NEAR(e.seen->accuracy.median, 1e-4, 1e-6);
  EXPECT_EQ(e.seen->scores[0].precision, 1);
  // What lies 10 mm too high counts as far only where two views see the ground.
  for (auto& x : mesh.vertices)
    if (x.x() > 0.05f) x.z() = 0.01f;
  e = evaluated(mesh, truth, views, with_samples(samples));
  EXPECT_NEAR(e.unseen->no_view, 5.0 / 8, 0.003);
  EXPECT_NEAR(e.unseen->far, 1.0 / 8, 0.02);  // a cell is 1/40 wide
  EXPECT_NEAR(e.seen->share, 2.0 / 8, 0.003);
  EXPECT_NEAR(e.seen->scores[0].precision, 0.5, 0.1);
}

}  // namespace
}  // namespace axial::evaluate
