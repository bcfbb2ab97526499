// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/bundle/tracks.h"

#include <gtest/gtest.h>

#include <random>

#include "pose/survey.h"

namespace axial::pose {
namespace {

using testing::camera_behind;
using testing::dome_port;
using testing::flat_port;
using testing::housed;
using testing::survey;
using Ray = refractive::AxialRay<double>;

Ray ray_to(const Eigen::Vector3d& point, const Eigen::Vector3d& from) {
  return {from, (point - from).normalized()};
}

TEST(Triangulate, FindsThePointOfRays) {
  const Eigen::Vector3d point(0.1, -0.2, 1.5);
  const std::vector<Ray> rays{ray_to(point, {0, 0, 0}), ray_to(point, {0.3, 0, 0.1}),
                              ray_to(point, {-0.2, 0.1, 0})};
  EXPECT_LT((*triangulate(rays) - point).norm(), 1e-12);
}

TEST(Triangulate, HasNoAnswerForOneRayOrParallelOnesOrPointsBehind) {
  const Eigen::Vector3d point(0, 0, 1);
  const std::vector<Ray> one{ray_to(point, {0, 0, 0})};
  EXPECT_FALSE(triangulate(one));
  const std::vector<Ray> parallel{{{0, 0, 0}, {0, 0, 1}}, {{1, 0, 0}, {0, 0, 1}}};
  EXPECT_FALSE(triangulate(parallel));
  const std::vector<Ray> apart{{{0, 0, 0}, Eigen::Vector3d(-0.1, 0, 1).normalized()},
                               {{1, 0, 0}, Eigen::Vector3d(0.1, 0, 1).normalized()}};
  EXPECT_FALSE(triangulate(apart));
}

TEST(TriangulateBundle, GoesThroughThePort) {
  for (const refractive::Port<double>& port :
       {refractive::Port<double>(flat_port(3, 0.1)), refractive::Port<double>(dome_port())}) {
    const Bundle truth = survey(camera_behind(port), {});
    Bundle bundle = truth;
    for (BundlePoint& point : bundle.points) point.position.setZero();
    triangulate(bundle);
    for (std::size_t i = 0; i < truth.points.size(); ++i)
      ASSERT_LT((bundle.points[i].position - truth.points[i].position).norm(), 1e-9);
  }
}

TEST(Filter, DropsWhatDoesNotFitAndKeepsTheRest) {
  Bundle bundle = survey(camera_behind(flat_port()), {});
  const std::size_t before = bundle.observations.size();
  bundle.observations[5].pixel.x() += 6;
  bundle.observations[50].pixel.y() -= 5;
  bundle.observations[100].pixel.y() -= 3;
  EXPECT_EQ(filter(bundle, {4, 0, 1}), 2u);
  EXPECT_EQ(bundle.observations.size(), before - 2);
  EXPECT_EQ(filter(bundle, {4, 0, 1}), 0u);
}

// Inserts copies of observations, moved at random, at any index: the original observations remain.
TEST(DropRepeated, KeepsTheNearestOfEachImage) {
  const Bundle truth = survey(camera_behind(flat_port()), {.points = 100});
  Bundle bundle = truth;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> shift(0.1, 5);
  for (int i = 0; i < 150; ++i) {
    Observation copy = truth.observations[random() % truth.observations.size()];
    copy.pixel.x() += shift(random);
    const auto place = static_cast<std::ptrdiff_t>(random() % bundle.observations.size());
    bundle.observations.insert(bundle.observations.begin() + place, copy);
  }
  EXPECT_EQ(drop_repeated(bundle), 150u);
  ASSERT_EQ(bundle.observations.size(), truth.observations.size());
  for (std::size_t i = 0; i < truth.observations.size(); ++i) {
    EXPECT_EQ(bundle.observations[i].image, truth.observations[i].image);
    EXPECT_EQ(bundle.observations[i].point, truth.observations[i].point);
    EXPECT_EQ(bundle.observations[i].pixel, truth.observations[i].pixel);
  }
  EXPECT_EQ(drop_repeated(bundle), 0u);
}

// Two pixels in one image are not two views of a point, even if no angle is required.
TEST(Filter, DropsPointsThatOneImageSees) {
  Bundle bundle = survey(camera_behind(flat_port()), {});
  const std::size_t points = bundle.points.size();
  std::erase_if(bundle.observations,
                [&](const Observation& observation) { return observation.point == 3; });
  Observation seen = bundle.observations.front();
  bundle.points[3].position = bundle.points[seen.point].position;
  seen.point = 3;
  for (const double shift : {0.0, 0.5}) {
    seen.pixel.x() += shift;
    bundle.observations.push_back(seen);
  }
  filter(bundle, {4, 0, 1});
  EXPECT_EQ(bundle.points.size(), points - 1);
}

TEST(Filter, ClosesRanksWhereAPointGoes) {
  Bundle bundle = survey(camera_behind(flat_port()), {});
  const std::size_t points = bundle.points.size();
  std::size_t of_third = 0;
  for (Observation& observation : bundle.observations)
    if (observation.point == 3) observation.pixel.x() += 20, ++of_third;
  EXPECT_EQ(filter(bundle, {4, 0, 1}), of_third);
  ASSERT_EQ(bundle.points.size(), points - 1);
  EXPECT_EQ(bundle.points[2].source, 2u);
  EXPECT_EQ(bundle.points[3].source, 4u);
  for (const double error : reprojection_errors(bundle)) ASSERT_LT(error, 1e-9);
}

TEST(Filter, DropsPointsSeenUnderNarrowAngles) {
  // Two cameras 0.1 m apart, points 1 m away: 5.7 degrees.
  Bundle bundle;
  bundle.cameras.push_back({housed(camera_behind(std::nullopt)), HousingChange<double>::Zero()});
  for (const double x : {0.0, 0.1}) bundle.images.push_back({"", 0, {{}, {x, 0, 0}}});
  for (BundleImage& image : bundle.images) image.pose.rotation.setIdentity();
  bundle.points.push_back({{0.05, 0, 1}, 0});
  const PhotographCamera camera(bundle.cameras[0].now());
  for (std::size_t i = 0; i < 2; ++i) {
    Observation seen;
    seen.image = i;
    seen.pixel = camera.image(bundle.images[i].pose.to_camera(bundle.points[0].position)).pixel;
    bundle.observations.push_back(seen);
  }
  EXPECT_EQ(filter(bundle, {4, 5.7, 1}), 0u);
  EXPECT_EQ(filter(bundle, {4, 5.8, 1}), 2u);
  EXPECT_TRUE(bundle.points.empty());
}

TEST(Filter, DropsImagesThatAreHardlySeen) {
  Bundle bundle = survey(camera_behind(flat_port()), {});
  std::size_t kept = 0;
  std::erase_if(bundle.observations, [&](const Observation& observation) {
    return observation.image == 4 && ++kept > 29;
  });
  EXPECT_GE(filter(bundle, {4, 0, 30}), 29u);
  EXPECT_EQ(observations_by_image(bundle)[4], 0u);
}

TEST(ReprojectionErrors, AreInfiniteForWhatIsNotSeen) {
  Bundle bundle = survey(camera_behind(flat_port()), {});
  const BundleImage& image = bundle.images[bundle.observations[0].image];
  bundle.points[bundle.observations[0].point].position =
      image.pose.to_world(Eigen::Vector3d(0, 0, -1));
  const std::vector<double> errors = reprojection_errors(bundle);
  EXPECT_TRUE(std::isinf(errors[0]));
  EXPECT_LT(errors.back(), 1e-9);
  EXPECT_EQ(root_mean_square(std::vector<double>{3, 4, errors[0]}), std::sqrt(12.5));
  EXPECT_EQ(root_mean_square({}), 0);
}

}  // namespace
}  // namespace axial::pose
