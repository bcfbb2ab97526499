// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/merge_points.h"

#include "sphere_cloud.h"

namespace axial::mesh {
namespace {

class MergePoints : public testing::TestWithParam<bool> {
 protected:
  Scene scene = test::cameras_around_sphere(GetParam());
  ViewRays rays{scene};
};
INSTANTIATE_TEST_SUITE_P(Media, MergePoints, testing::Bool());

TEST_P(MergePoints, KeepsAllPointsAndViewsWithoutADistance) {
  const PointCloud cloud = test::points_on_sphere(scene, 500);
  const MergedPoints merged = merge_points(cloud, rays, {0});
  EXPECT_EQ(merged.size(), cloud.size());
  EXPECT_EQ(merged.view_images.size(), cloud.view_images.size());
}

TEST_P(MergePoints, ResultsAreTheDistanceApartInAView) {
  const PointCloud cloud = test::points_on_sphere(scene, 10000);
  const double distance = 8;
  const MergedPoints merged = merge_points(cloud, rays, {distance});
  EXPECT_LT(merged.size(), cloud.size() / 4);
  // Positions are means of points up to `distance` away, so results may be nearer than it; not
  // nearer than a quarter.
  for (std::size_t i = 0; i < merged.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const Eigen::Vector3f step = merged.positions[i] - merged.positions[k];
      ASSERT_GT(step.norm(), 0.25 * distance * merged.pixel_widths[i]) << i << " " << k;
    }
}

TEST_P(MergePoints, TooManyPointsAreCountedButNotKept) {
  const PointCloud cloud = test::points_on_sphere(scene, 5000);
  const MergedPoints all = merge_points(cloud, rays, {8});
  EXPECT_EQ(all.count, all.size());
  const MergedPoints same = merge_points(cloud, rays, {8, all.size()});
  EXPECT_EQ(same.positions, all.positions);
  const MergedPoints none = merge_points(cloud, rays, {8, all.size() - 1});
  EXPECT_EQ(none.count, all.size());
  EXPECT_EQ(none.size(), 0u);
}

TEST_P(MergePoints, CountsThePointsOfEachView) {
  const PointCloud cloud = test::points_on_sphere(scene, 20000);
  const MergedPoints merged = merge_points(cloud, rays, {4});
  float sum = 0;
  for (const float weight : merged.view_weights) sum += weight;
  EXPECT_EQ(sum, static_cast<float>(cloud.view_images.size()));
}

TEST_P(MergePoints, MeansAreNearerToTheSurfaceThanPoints) {
  const double noise = 0.002;
  const PointCloud cloud = test::points_on_sphere(scene, 40000, noise);
  const MergedPoints merged = merge_points(cloud, rays, {6});
  const auto error = [](const std::vector<Eigen::Vector3f>& points) {
    double sum = 0;
    for (const Eigen::Vector3f& p : points)
      sum += std::abs(p.cast<double>().norm() - test::kSphereRadius);
    return sum / static_cast<double>(points.size());
  };
  // About ten points are merged to one, so that the error falls to a third.
  EXPECT_LT(error(merged.positions), 0.5 * error(cloud.positions));
}

TEST_P(MergePoints, DropsPointsThatNoCameraSees) {
  PointCloud cloud = test::points_on_sphere(scene, 10);
  cloud.positions.emplace_back(50, 0, 0);  // behind the camera of its view
  cloud.normals.emplace_back(1, 0, 0);
  cloud.view_images.push_back(1);
  cloud.view_begin.push_back(cloud.view_images.size());
  EXPECT_EQ(merge_points(cloud, rays, {0}).size(), 10u);
}

TEST_P(MergePoints, AResultDoesNotJoinBothSidesOfASheet) {
  PointCloud cloud = test::points_on_sphere(scene, 2);
  cloud.positions[1] = cloud.positions[0];
  cloud.normals[1] = -cloud.normals[0];
  EXPECT_EQ(merge_points(cloud, rays, {100}).size(), 2u);
  cloud.normals[1] = cloud.normals[0];
  EXPECT_EQ(merge_points(cloud, rays, {100}).size(), 1u);
}

// The ray in water is straight: the pixel of every point on it is the same.
TEST_P(MergePoints, ExitPointsLieOnTheRayOfThePixel) {
  const PointCloud cloud = test::points_on_sphere(scene, 50);
  for (std::size_t i = 0; i < cloud.size(); ++i)
    for (const std::uint32_t view : cloud.views_of(i)) {
      const Eigen::Vector3d at = cloud.positions[i].cast<double>();
      const auto exit = rays.exit_point(view, at);
      ASSERT_TRUE(exit);
      const AnyCamera<double> camera(make_camera<double>(scene.images[view].camera));
      const auto pixel = [&](const Eigen::Vector3d& x) {
        return camera.project(scene.images[view].pose.to_camera(x)).pixel;
      };
      EXPECT_LT((pixel(at) - pixel(at + 0.5 * (*exit - at))).norm(), 1e-6);
      // A port has its outer surface 6 cm in front of the centre.
      const double from_centre = (*exit - scene.images[view].pose.centre).norm();
      EXPECT_GE(from_centre, GetParam() ? 0.06 - 1e-9 : 0);
      EXPECT_LT(from_centre, GetParam() ? 0.1 : 1e-12);
    }
}

}  // namespace
}  // namespace axial::mesh
