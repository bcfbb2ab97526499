// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/reconstruct.h"

#include "base/error.h"
#include "base/parallel.h"
#include "sphere_cloud.h"
#include "support/error_of.h"
#include "topology.h"

namespace axial::mesh {
namespace {

using test::error_of;

using test::kSphereRadius;
using testing::HasSubstr;

class Reconstruct : public testing::TestWithParam<bool> {
 protected:
  Scene scene = test::cameras_around_sphere(GetParam());
};
INSTANTIATE_TEST_SUITE_P(Media, Reconstruct, testing::Bool());

ReconstructOptions merging(double min_distance) {
  ReconstructOptions options;
  options.merge.min_distance = min_distance;
  return options;
}

double volume(const Mesh& mesh) {
  double sum = 0;
  for (const auto& face : mesh.faces)
    sum += mesh.vertices[face[0]].cast<double>().dot(
               mesh.vertices[face[1]].cast<double>().cross(mesh.vertices[face[2]].cast<double>())) /
           6;
  return sum;
}

TEST_P(Reconstruct, ASphereIsClosedManifoldAndRound) {
  const Mesh mesh = reconstruct(test::points_on_sphere(scene, 3000), scene, merging(0));
  const test::MeshFacts facts = test::facts_of(mesh);
  EXPECT_EQ(facts.border_edges, 0u);
  EXPECT_EQ(facts.bad_edges, 0u);
  EXPECT_EQ(facts.bad_vertices, 0u);
  EXPECT_EQ(facts.unused_vertices, 0u);
  EXPECT_EQ(facts.euler, 2);
  // Positive: normals point outwards. The volume of the inscribed polyhedron with 3,000 corners is
  // 0.3 % smaller than the sphere's.
  EXPECT_NEAR(volume(mesh) / (4 / 3.0 * std::numbers::pi * std::pow(kSphereRadius, 3)), 1, 0.006);
}

TEST_P(Reconstruct, TheSideThatNoCameraSeesIsLeftOpen) {
  PointCloud cloud = test::points_on_sphere(scene, 6000);
  PointCloud seen;
  seen.view_begin.push_back(0);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (std::ranges::find(cloud.views_of(i), 0u) == cloud.views_of(i).end()) continue;
    seen.positions.push_back(cloud.positions[i]);
    seen.view_images.push_back(0);
    seen.view_begin.push_back(seen.view_images.size());
  }
  const Mesh mesh = reconstruct(seen, scene, merging(0));
  EXPECT_GT(test::facts_of(mesh).border_edges, 20u);
  for (const auto& face : mesh.faces) {
    const Eigen::Vector3f centre =
        (mesh.vertices[face[0]] + mesh.vertices[face[1]] + mesh.vertices[face[2]]) / 3;
    // A face with edges of 90 mm, 6.7 times the median, lies up to 5 mm below the sphere; a face
    // that closes the open side lies 100 mm below it.
    EXPECT_NEAR(centre.norm(), kSphereRadius, 0.04 * kSphereRadius);
  }
}

TEST_P(Reconstruct, NoisyPointsGiveNoSecondSurface) {
  PointCloud cloud = test::points_on_sphere(scene, 8000, 0.001);
  // One point in eight lies inside the sphere: all others' rays cross the space in front of it.
  for (std::size_t i = 0; i < cloud.size(); i += 8) cloud.positions[i] *= 0.8f;
  const Mesh mesh = reconstruct(cloud, scene, merging(2));
  const test::MeshFacts facts = test::facts_of(mesh);
  EXPECT_EQ(facts.bad_edges + facts.bad_vertices, 0u);
  EXPECT_NEAR(volume(mesh) / (4 / 3.0 * std::numbers::pi * std::pow(kSphereRadius, 3)), 1, 0.03);
}

TEST_P(Reconstruct, ThreadsDoNotChangeTheMesh) {
  const PointCloud cloud = test::points_on_sphere(scene, 5000, 0.002);
  std::vector<Mesh> meshes;
  for (const unsigned threads : {1u, 4u}) {
    const ThreadLimit limit(threads);
    for (const bool weak : {false, true}) {
      ReconstructOptions options;
      options.votes.weak_support = weak;
      meshes.push_back(reconstruct(cloud, scene, options));
    }
  }
  for (const std::size_t k : {0u, 1u}) {
    EXPECT_EQ(meshes[k].vertices, meshes[k + 2].vertices);
    EXPECT_EQ(meshes[k].faces, meshes[k + 2].faces);
  }
}

TEST_P(Reconstruct, TheRegionLimitsPointsOrSurface) {
  scene.region = OrientedBox{Eigen::Matrix3d::Identity(), {0, 0, 1}, {2, 2, 1}};  // z >= 0
  const PointCloud cloud = test::points_on_sphere(scene, 3000);
  for (const bool only : {false, true}) {
    ReconstructOptions options;
    options.only_region = only;
    options.crop_to_region = !only;
    for (const Eigen::Vector3f& v : reconstruct(cloud, scene, options).vertices)
      ASSERT_GE(v.z(), -1e-6f);
  }
  ReconstructOptions whole;
  whole.crop_to_region = false;
  float lowest = 0;
  for (const Eigen::Vector3f& v : reconstruct(cloud, scene, whole).vertices)
    lowest = std::min(lowest, v.z());
  EXPECT_LT(lowest, -0.9 * kSphereRadius);
}

TEST_P(Reconstruct, RefusesWhatIsNoCloudOfTheScene) {
  const PointCloud good = test::points_on_sphere(scene, 100);
  const auto refused = [&](const PointCloud& cloud, const ReconstructOptions& options = {}) {
    return error_of([&] { reconstruct(cloud, scene, options); });
  };
  EXPECT_THAT(refused({}), HasSubstr("no points"));
  PointCloud bad = good;
  bad.view_begin.clear();
  EXPECT_THAT(refused(bad), HasSubstr("no views"));
  bad = good;
  bad.view_images[bad.view_begin[7]] = 6;
  EXPECT_THAT(refused(bad), HasSubstr("point 7 names view 6"));
  bad = good;
  bad.positions[3].x() = std::nanf("");
  EXPECT_THAT(refused(bad), HasSubstr("point 3"));
  const Context context({}, {}, {MemoryBudget::of_bytes(1000)});
  EXPECT_THAT(error_of([&] { reconstruct(good, scene, {}, context); }), HasSubstr("max_memory"));
  bad = good;
  bad.view_weights.assign(bad.view_images.size(), 1);
  for (const float weight : {std::nanf(""), -1.0f, 1e30f}) {
    bad.view_weights[5] = weight;
    EXPECT_THAT(refused(bad), HasSubstr("weight"));
  }
  scene.images[2].calibrated = false;
  EXPECT_THAT(refused(good), HasSubstr("without calibration"));
}

}  // namespace
}  // namespace axial::mesh
