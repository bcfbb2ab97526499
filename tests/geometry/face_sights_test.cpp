// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/face_sights.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>

#include "scene/camera_model.h"
#include "worlds/height_field.h"
#include "worlds/ports.h"

namespace axial::geometry {
namespace {

// A face at the height z below the cameras, whose front is turned upwards (towards -z).
Mesh face_at(float z, float size) {
  return {{{-size, -size, z}, {size, -size, z}, {0, 2 * size, z}}, {}, {{0, 2, 1}}};
}

PosedCamera camera_at(const Eigen::Vector3d& centre, bool wet) {
  return test::camera_at(centre, 200, 160, 200, wet);
}

TEST(FaceSights, CountsTheSideThatIsTurnedToTheCamera) {
  for (const bool wet : {false, true}) {
    Mesh mesh = face_at(1, 0.1f);
    const std::vector cameras = {camera_at({0, 0, 0}, wet), camera_at({0.1, 0, 0}, wet),
                                 camera_at({0, 0, 2}, wet)};  // the last looks away from the face
    FaceSights sights = count_sights(mesh, cameras);
    EXPECT_THAT(sights.front, testing::ElementsAre(2));
    EXPECT_THAT(sights.back, testing::ElementsAre(0));
    std::swap(mesh.faces[0][0], mesh.faces[0][1]);
    sights = count_sights(mesh, cameras);
    EXPECT_THAT(sights.front, testing::ElementsAre(0));
    EXPECT_THAT(sights.back, testing::ElementsAre(2));
  }
}

TEST(FaceSights, FacesHideThoseBehindThem) {
  Mesh mesh = face_at(1, 0.1f);
  test::append(mesh, face_at(2, 0.1f));
  // From far to the side, the first face does not hide the second one.
  const std::vector cameras = {camera_at({0, 0, 0}, true), camera_at({0.6, 0, 0}, true)};
  const FaceSights sights = count_sights(mesh, cameras);
  EXPECT_THAT(sights.front, testing::ElementsAre(1, 1));
}

TEST(FaceSights, FacesOutsideTheImageAndWithoutAreaAreNotSeen) {
  Mesh mesh = face_at(1, 0.1f);
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex.x() += 2;
  mesh.faces.push_back({0, 0, 1});
  const FaceSights sights = count_sights(mesh, std::vector{camera_at({0, 0, 0}, false)});
  EXPECT_THAT(sights.front, testing::ElementsAre(0, 0));
  EXPECT_THAT(sights.back, testing::ElementsAre(0, 0));
}

TEST(FaceSights, GrazingSightsDoNotCountBelowTheLeastCosine) {
  Mesh mesh = face_at(1, 0.01f);
  const std::vector cameras = {camera_at({0.4, 0, 0}, false)};  // cosine 0.93
  EXPECT_THAT(count_sights(mesh, cameras, {.least_cosine = 0.9}).front, testing::ElementsAre(1));
  EXPECT_THAT(count_sights(mesh, cameras, {.least_cosine = 0.95}).front, testing::ElementsAre(0));
}

TEST(FaceSights, TheSecondBestCameraCounts) {
  Mesh mesh = face_at(1, 0.01f);
  const auto seconds = [&](std::initializer_list<double> places, float enough) {
    std::vector<PosedCamera> cameras;
    for (const double x : places) cameras.push_back(camera_at({x, 0, 0}, false));
    return second_cosines(mesh, cameras, enough)[0];
  };
  // Cosines 1, 0.981 and 0.928. The fourth camera does not see the face.
  const float expected = static_cast<float>(1 / std::sqrt(1 + 0.2 * 0.2));
  EXPECT_NEAR(seconds({0.0, 0.2, 0.4, -3.0}, 2), expected, 1e-6f);
  EXPECT_NEAR(seconds({-3.0, 0.4, 0.2, 0.0}, 2), expected, 1e-6f);
  EXPECT_GE(seconds({0.4, 0.2, 0.0}, 0.5f), 0.5f);
  EXPECT_EQ(seconds({0.0, -3.0}, 2), -1);
  std::swap(mesh.faces[0][0], mesh.faces[0][1]);
  EXPECT_EQ(seconds({0.0, 0.2, 0.4}, 2), -1);
}

// The cone that saves projections must not cut off what a camera sees: with a wide lens, a tilted
// port and a camera far from the glass.
TEST(FaceSights, EveryPlaceInTheImageIsSeen) {
  for (const double distance : {0.0, 0.01, 0.2}) {
    PosedCamera posed = camera_at({0.3, -0.2, 0.1}, false);
    posed.camera.lens = {60, 60, 120.5, 60.5};
    posed.pose.rotation = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
    if (distance > 0)
      posed.camera.port = refractive::FlatPort<double>{
          Eigen::Vector3d(0.1, -0.05, 1).normalized(), distance, 0.02, 1, 1.5, 1.34};
    Mesh mesh;
    std::visit(
        [&](const auto& camera) {
          for (int y = 0; y < posed.camera.height; y += 9)
            for (int x = 0; x < posed.camera.width; x += 11) {
              const auto ray = camera.ray(Eigen::Vector2d(x, y));
              const Eigen::Vector3d at = posed.pose.to_world(ray.at(2));
              const Eigen::Vector3d towards = posed.pose.rotation.transpose() * ray.direction;
              const Eigen::Vector3d u = towards.unitOrthogonal(), v = towards.cross(u);
              const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
              for (const Eigen::Vector3d& aside : {u, Eigen::Vector3d(v - u), Eigen::Vector3d(-v)})
                mesh.vertices.push_back((at + 1e-4 * aside).cast<float>());
              mesh.faces.push_back({first, first + 2, first + 1});
            }
        },
        make_camera<double>(posed.camera));
    const FaceSights sights = count_sights(mesh, std::vector{posed});
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
      ASSERT_EQ(sights.front[f] + sights.back[f], 1) << distance << " " << f;
  }
}

}  // namespace
}  // namespace axial::geometry
