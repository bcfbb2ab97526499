// SPDX-License-Identifier: GPL-3.0-or-later
// Poses of single photographs from known points.
#include "pose/registration/absolute_pose.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "drawn.h"
#include "pose/registration/p3p.h"
#include "pose/registration/sightings.h"
#include "pose/survey.h"

namespace axial::pose {
namespace {

using testing::camera_behind;
using testing::dome_port;
using testing::flat_port;
using ::testing::HasSubstr;
using testing::kDegree;

double angle_between(const Pose& a, const Pose& b) {
  return Eigen::AngleAxisd(a.rotation * b.rotation.transpose()).angle();
}

// The nearest of `poses` to `truth`: the distance of the centres, relative to `distance`, and the
// angle together.
double nearest(const std::vector<Pose>& poses, const Pose& truth, double distance) {
  double least = 1e9;
  for (const Pose& pose : poses)
    least = std::min(least,
                     (pose.centre - truth.centre).norm() / distance + angle_between(pose, truth));
  return least;
}

struct PosedCase {
  const char* name;
  std::optional<refractive::Port<double>> port;
  double distance;  // of the ground [m]
};

class AbsolutePoseTest : public ::testing::TestWithParam<PosedCase> {
 protected:
  Bundle truth_ = testing::survey(camera_behind(GetParam().port),
                                  {.distance = GetParam().distance, .noise = 0.3});

  std::vector<Sighting> sightings_of_image(std::size_t image) const {
    std::vector<Sighting> sightings;
    for (const Observation& observation : truth_.observations)
      if (observation.image == image)
        sightings.push_back({observation.pixel, truth_.points[observation.point].position});
    return sightings;
  }
};

TEST_P(AbsolutePoseTest, ThreePointsHaveTheTruePose) {
  const PhotographCamera camera(truth_.cameras[0].now());
  int missed = 0;
  for (std::size_t image = 0; image < truth_.images.size(); ++image) {
    const Pose& pose = truth_.images[image].pose;
    const std::vector<Sighting> all = sightings_of_image(image);
    for (std::size_t k = 0; k + 40 < all.size(); k += 20) {
      ThreeRays rays;
      ThreeVectors points;
      for (std::size_t i = 0; i < 3; ++i) {
        points[i] = all[k + 20 * i].point;
        rays[i] = camera.ray(camera.image(pose.to_camera(points[i])).pixel);
      }
      // The scale of the scene need not be known well.
      missed += nearest(poses_of_three(rays, points, 1.3 * GetParam().distance), pose,
                        GetParam().distance) > 1e-4;
    }
  }
  EXPECT_LE(missed, 3);
}

TEST_P(AbsolutePoseTest, WrongMatchesDoNotMatter) {
  std::mt19937_64 random(3);
  std::vector<Sighting> sightings = sightings_of_image(4);
  const std::size_t right = sightings.size();
  for (std::size_t i = 0; i < right; ++i)  // half of all matches are wrong
    sightings.push_back({sightings[random() % right].pixel, sightings[random() % right].point});
  const AbsolutePoseOptions options{4, GetParam().distance, 5};
  const AbsolutePose found = absolute_pose(truth_.cameras[0], sightings, options);
  EXPECT_GE(found.inliers.size(), right);
  EXPECT_LE(found.inliers.size(), right + 3);
  const Pose& pose = truth_.images[4].pose;
  EXPECT_LT((found.pose.centre - pose.centre).norm(), 2e-3 * GetParam().distance);
  EXPECT_LT(angle_between(found.pose, pose), 0.1 * kDegree);
  const PoseDoubt doubt = doubt_of(truth_.cameras[0], sightings, found);
  EXPECT_LT((found.pose.centre - pose.centre).norm(), 4 * doubt.centre * GetParam().distance);
  EXPECT_LT(doubt.angle, 0.1 * kDegree);
  EXPECT_EQ(place_of(truth_.cameras[0], sightings, options, {}).why_not, "");
}

TEST_P(AbsolutePoseTest, MatchesAtRandomGiveNoPose) {
  std::mt19937_64 random(3);
  const std::vector<Sighting> all = sightings_of_image(4);
  std::vector<Sighting> sightings;
  for (std::size_t i = 0; i < 300; ++i)
    sightings.push_back({all[random() % all.size()].pixel, all[random() % all.size()].point});
  const Place place = place_of(truth_.cameras[0], sightings, {4, GetParam().distance, 5}, {});
  EXPECT_THAT(place.why_not, HasSubstr("of 300 matches with points agree with one pose"));
}

// As of a row of equal things: each point occurs again, 0.3 m beside the first place.
TEST_P(AbsolutePoseTest, TwoPlacesGiveNoPose) {
  std::vector<Sighting> sightings = sightings_of_image(4);
  const std::size_t right = sightings.size();
  for (std::size_t i = 0; i < right; ++i)
    sightings.push_back({sightings[i].pixel, sightings[i].point + Eigen::Vector3d(0.3, 0, 0)});
  const Place place = place_of(truth_.cameras[0], sightings, {4, GetParam().distance, 5}, {});
  EXPECT_THAT(place.why_not, HasSubstr("agree with two poses"));
}

TEST_P(AbsolutePoseTest, MatchesInOneCornerGiveNoPose) {
  std::vector<Sighting> sightings;
  const std::vector<Sighting> all = sightings_of_image(4);
  for (int k = 0; k < 40; ++k)
    sightings.push_back(
        {all[0].pixel + Eigen::Vector2d(0.1 * (k % 7), 0.1 * (k % 6)),
         all[0].point + 1e-4 * GetParam().distance * Eigen::Vector3d(k % 7, k % 6, k % 5)});
  const Place place = place_of(truth_.cameras[0], sightings, {4, GetParam().distance, 5}, {});
  EXPECT_THAT(place.why_not, HasSubstr("determine its pose to"));
}

TEST_P(AbsolutePoseTest, PointsBehindThePortAgreeWithNoPose) {
  std::vector<Sighting> sightings = sightings_of_image(4);
  const Pose& pose = truth_.images[4].pose;
  for (Sighting& sighting : sightings)  // mirrored at the camera centre
    sighting.point = 2 * pose.centre - sighting.point;
  const Place place = place_of(truth_.cameras[0], sightings, {4, GetParam().distance, 5}, {});
  EXPECT_THAT(place.why_not, HasSubstr("agree with one pose"));
}

INSTANTIATE_TEST_SUITE_P(Ports, AbsolutePoseTest,
                         ::testing::Values(PosedCase{"None", std::nullopt, 0.8},
                                           PosedCase{"Flat", flat_port(3), 0.8},
                                           PosedCase{"FarFlat", flat_port(10, 0.15), 0.8},
                                           PosedCase{"Dome", dome_port(), 0.8},
                                           PosedCase{"Wide", flat_port(2), 3}),
                         [](const auto& param) { return param.param.name; });

TEST(P3pTest, FindsAtMostFourPosesAndAllAreRight) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vector = [&] { return axial::test::drawn<3>(uniform, random); };
  int missed = 0;
  for (int k = 0; k < 300; ++k) {
    const Pose truth = testing::looking_at(3 * vector() - Eigen::Vector3d(0, 0, 5), vector(), k);
    ThreeVectors bearings, points;
    for (std::size_t i = 0; i < 3; ++i) {
      points[i] = vector();
      bearings[i] = truth.to_camera(points[i]).normalized();
    }
    const std::vector<Pose> poses = p3p(bearings, points);
    EXPECT_LE(poses.size(), 4u);
    missed += nearest(poses, truth, 1) > 1e-5;
    for (const Pose& pose : poses) EXPECT_NEAR(std::abs(pose.rotation.determinant() - 1), 0, 1e-9);
  }
  EXPECT_LE(missed, 3);  // near double roots
}

TEST(P3pTest, PointsOnALineGiveNoPose) {
  const ThreeVectors points{Eigen::Vector3d(0, 0, 2), Eigen::Vector3d(1, 0, 2),
                            Eigen::Vector3d(2, 0, 2)};
  EXPECT_TRUE(p3p({points[0].normalized(), points[1].normalized(), points[2].normalized()}, points)
                  .empty());
}

}  // namespace
}  // namespace axial::pose
