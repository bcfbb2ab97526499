// SPDX-License-Identifier: GPL-3.0-or-later
// Exact depth maps of a plane must agree with points on the plane. A change of one number of port,
// lens or scale must be detected; noise without such a change must not.
#include "depth/agreement.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <random>
#include <string>
#include <utility>

#include "scene/camera_model.h"
#include "support/analytic_scene.h"

namespace axial::depth {
namespace {

constexpr std::size_t kViews = 5;

// All cameras look along z, as in a survey. If all cameras were turned to one point of a flat
// scene, a wrong angle of view would also give a flat scene.
std::vector<DepthMap> maps_of(const test::AnalyticScene& scene, const CameraModel& camera) {
  std::vector<DepthMap> maps;
  for (Pose pose : test::circle_of_poses(kViews)) {
    pose.rotation.setIdentity();
    maps.push_back(test::exact_map(scene, camera, pose));
    maps.back().confidence.release();
  }
  return maps;
}

// Points on the plane, around the centre of the area that the cameras see.
std::vector<Eigen::Vector3f> points_on(const test::AnalyticScene& scene, std::size_t count) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> across(-0.6, 0.6);
  std::vector<Eigen::Vector3f> points;
  while (points.size() < count) {
    const Eigen::Vector3d x(across(random), across(random), 0);
    const double z = scene.plane.signedDistance(x) / -scene.plane.normal().z();
    points.push_back((x + z * Eigen::Vector3d::UnitZ()).cast<float>());
  }
  return points;
}

Agreement agreement_of(const std::vector<DepthMap>& maps,
                       const std::vector<Eigen::Vector3f>& points) {
  std::vector<MapAgreement> found;
  for (std::size_t i = 0; i < maps.size(); ++i) {
    std::vector<const DepthMap*> neighbours;
    for (std::size_t k = 1; k < 4; ++k) neighbours.push_back(&maps[(i + k) % maps.size()]);
    found.push_back(compare_map(maps[i], neighbours, points));
  }
  return summarise(found);
}

const test::AnalyticScene kPlane;

TEST(Agreement, ExactMapsAgree) {
  for (const CameraModel& camera : {test::dry_camera(), test::behind_port(test::dry_camera())}) {
    const Agreement found = agreement_of(maps_of(kPlane, camera), points_on(kPlane, 800));
    EXPECT_GT(found.points, 1000u);
    // The map's depth is that of the nearest pixel's centre, up to half a pixel away.
    EXPECT_LT(found.share, 0.002);
    EXPECT_LT(found.pixels, 0.1);
    EXPECT_LT(found.systematic, 0.03);
    EXPECT_GT(found.consistent, 0.99);
    EXPECT_FALSE(judge(found).any());
  }
}

// The ray of a pixel in the world frame.
template <class Camera>
refractive::AxialRay<double> world_ray(const Camera& camera, const Pose& pose,
                                       const Eigen::Vector2d& pixel) {
  const auto ray = camera.ray(pixel);
  return {pose.to_world(ray.origin), pose.rotation.transpose() * ray.direction};
}

// The distance along `a` at which the two rays are nearest to each other.
double nearest_to(const refractive::AxialRay<double>& a, const refractive::AxialRay<double>& b) {
  const Eigen::Vector3d between = b.origin - a.origin;
  const double cosine = a.direction.dot(b.direction);
  return (between.dot(a.direction) - cosine * between.dot(b.direction)) / (1 - cosine * cosine);
}

// The depth map that a perfect matcher computes with the camera `wrong`. For each pixel it knows
// the pixel of the image at `other` that shows the same surface point, and intersects their two
// rays.
DepthMap matched(const DepthMap& map, const Pose& other, const CameraModel& wrong) {
  DepthMap result = map;
  result.camera = wrong;
  result.depth = map.depth.clone();
  std::visit(
      [&](const auto& truly, const auto& wrongly) {
        for (int y = 0; y < map.height(); ++y)
          for (int x = 0; x < map.width(); ++x) {
            const Eigen::Vector2d pixel(x, y);
            const Eigen::Vector3d surface =
                world_ray(truly, map.pose, pixel).at(static_cast<double>(map.depth(y, x)));
            const auto seen = truly.project(other.to_camera(surface));
            const double depth = nearest_to(world_ray(wrongly, map.pose, pixel),
                                            world_ray(wrongly, other, seen.pixel));
            result.depth(y, x) = seen.visible && depth > 0 ? static_cast<float>(depth) : 0;
          }
      },
      make_camera<double>(map.camera), make_camera<double>(wrong));
  return result;
}

std::vector<DepthMap> seen_through(const std::vector<DepthMap>& maps,
                                   const std::function<void(CameraModel&)>& change) {
  CameraModel wrong = maps.front().camera;
  change(wrong);
  std::vector<DepthMap> result;
  for (std::size_t i = 0; i < maps.size(); ++i)
    result.push_back(matched(maps[i], maps[(i + 1) % maps.size()].pose, wrong));
  return result;
}

refractive::FlatPort<double>& port_of(CameraModel& camera) {
  return std::get<refractive::FlatPort<double>>(*camera.port);
}

TEST(Agreement, LowScoresShowWhereMapsAgree) {
  std::vector<DepthMap> maps = maps_of(kPlane, test::behind_port(test::dry_camera()));
  const std::vector<Eigen::Vector3f> points = points_on(kPlane, 800);
  EXPECT_EQ(agreement_of(maps, points).scored, 0u) << "maps without confidence";
  const AgreementLimits limits;
  for (const double offset : {-0.1, -0.01, 0.01, 0.1}) {
    const double score = limits.score + offset;
    for (DepthMap& map : maps)
      map.confidence = cv::Mat1f(map.depth.size(), static_cast<float>(score));
    Agreement found = agreement_of(maps, points);
    EXPECT_GT(found.scored, limits.min_points);
    EXPECT_NEAR(found.score, score, 1e-6);
    EXPECT_EQ(judge(found).score, offset < 0);
    EXPECT_FALSE(judge(found).cameras());
    found.scored = limits.min_points - 1;
    EXPECT_FALSE(judge(found).any());
  }
}

TEST(Agreement, EachWrongNumberOfTheCameraShows) {
  const std::vector<DepthMap> right = maps_of(kPlane, test::behind_port(test::dry_camera()));
  const std::vector<Eigen::Vector3f> points = points_on(kPlane, 800);
  EXPECT_FALSE(judge(agreement_of(seen_through(right, [](CameraModel&) {}), points)).any());
  const std::vector<std::pair<std::string, std::function<void(CameraModel&)>>> changes{
      {"distance", [](CameraModel& c) { port_of(c).distance *= 10; }},
      {"normal", [](CameraModel& c) { port_of(c).normal = Eigen::Vector3d(1, 0, 1).normalized(); }},
      {"n_water 1", [](CameraModel& c) { port_of(c).n_water = 1; }},
      {"n_water 1.49", [](CameraModel& c) { port_of(c).n_water = 1.49; }},
      {"focal length", [](CameraModel& c) { c.lens.fx *= 1.333, c.lens.fy *= 1.333; }},
      {"no port", [](CameraModel& c) { c.port.reset(); }}};
  for (const auto& [name, change] : changes)
    EXPECT_TRUE(judge(agreement_of(seen_through(right, change), points)).any())
        << name << " " << agreement_of(seen_through(right, change), points).systematic;
}

std::vector<Eigen::Vector3f> with_relative_errors(std::vector<Eigen::Vector3f> points,
                                                  const std::function<float()>& share) {
  for (Eigen::Vector3f& point : points) point *= 1 + share();
  return points;
}

// Two percent of the depth are a third of a pixel in this scene.
TEST(Agreement, TellsASystematicDifferenceFromNoise) {
  const std::vector<DepthMap> maps = maps_of(kPlane, test::behind_port(test::dry_camera()));
  const std::vector<Eigen::Vector3f> points = points_on(kPlane, 800);
  std::mt19937 random(7);
  std::normal_distribution<float> noise(0, 0.02f);
  const Agreement noisy =
      agreement_of(maps, with_relative_errors(points, [&] { return noise(random); }));
  const Agreement shifted = agreement_of(maps, with_relative_errors(points, [] { return 0.02f; }));
  EXPECT_GT(noisy.pixels, 0.1);
  EXPECT_LT(noisy.pixels, shifted.pixels);
  EXPECT_FALSE(judge(noisy).any()) << noisy.systematic << " " << noisy.significance;
  EXPECT_TRUE(judge(shifted).systematic) << shifted.systematic << " " << shifted.significance;
  EXPECT_NEAR(shifted.share, 0.02, 0.004) << "of the depth, as stated";
  EXPECT_GT(shifted.consistent, 0.99) << "the maps are as they were";
}

// Maps of random depths are not consistent with each other, whatever the points are.
TEST(Agreement, CountsPixelsThatNoNeighbourConfirms) {
  std::vector<DepthMap> maps = maps_of(kPlane, test::dry_camera());
  const std::vector<Eigen::Vector3f> points = points_on(kPlane, 800);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> factor(0.4f, 2.5f);
  for (std::size_t i = 0; i < maps.size(); ++i)
    for (float& depth : maps[i].depth) depth *= factor(random);
  const Agreement found = agreement_of(maps, points);
  EXPECT_LT(found.consistent, 0.4);
  EXPECT_TRUE(judge(found).consistent);
}

// With a correct map and one neighbour with wrong depths, it is unknown which of the two is wrong.
TEST(Agreement, OneNeighbourDoesNotTellWhichMapIsWrong) {
  std::vector<DepthMap> maps = maps_of(kPlane, test::dry_camera());
  maps[1].depth *= 1.5f;
  const DepthMap* const neighbours[] = {&maps[1], &maps[2]};
  const std::vector<Eigen::Vector3f> points = points_on(kPlane, 800);
  const MapAgreement one = compare_map(maps[0], std::span(neighbours, 1), points);
  EXPECT_EQ(one.asked, 0u);
  EXPECT_GT(one.points.size(), 100u);
  const MapAgreement two = compare_map(maps[0], neighbours, points);
  EXPECT_GT(two.asked, 100u);
  EXPECT_GT(two.consistent, two.asked * 9 / 10);
}

// Without data nothing is judged: no points, points that do not project, no depths, no neighbours.
TEST(Agreement, SaysNothingWithoutData) {
  const std::vector<DepthMap> maps = maps_of(kPlane, test::dry_camera());
  const DepthMap* const neighbour = &maps[1];
  const std::vector<Eigen::Vector3f> behind{
      {0, 0, -1}, Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN())};
  DepthMap empty = maps[0];
  empty.depth = cv::Mat1f(empty.depth.size(), 0.0f);
  const std::vector<Eigen::Vector3f> points = points_on(kPlane, 800);
  const std::vector<MapAgreement> found{compare_map(maps[0], std::span(&neighbour, 1), {}),
                                        compare_map(maps[0], std::span(&neighbour, 1), behind),
                                        compare_map(empty, std::span(&neighbour, 1), points),
                                        compare_map(maps[0], {}, points)};
  const Agreement sum = summarise(found);
  EXPECT_EQ(sum.points, 0u);
  EXPECT_EQ(sum.asked, 0u);
  EXPECT_FALSE(judge(sum).any());
  EXPECT_FALSE(judge(summarise({})).any());
}

TEST(Agreement, TakesManyPointsEvenly) {
  const std::vector<DepthMap> maps = maps_of(kPlane, test::dry_camera());
  const DepthMap* const neighbours[] = {&maps[1], &maps[2]};
  const std::vector<Eigen::Vector3f> points = points_on(kPlane, 5000);
  const MapAgreement all = compare_map(maps[0], neighbours, points, 5000);
  const MapAgreement part = compare_map(maps[0], neighbours, points, 500);
  EXPECT_GT(all.asked, 1000u);
  EXPECT_LE(part.asked, 500u);
  EXPECT_NEAR(static_cast<double>(part.asked), 0.1 * static_cast<double>(all.asked),
              0.02 * static_cast<double>(all.asked));
}

}  // namespace
}  // namespace axial::depth
