// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/face_sights.h"

#include <gmock/gmock.h>

namespace axial::geometry {
namespace {

// A face at the height z below the cameras, whose front is turned upwards (towards -z) or
// downwards.
void add_face(Mesh& mesh, float z, float size, bool upwards) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.emplace_back(-size, -size, z);
  mesh.vertices.emplace_back(size, -size, z);
  mesh.vertices.emplace_back(0.0f, 2 * size, z);
  if (upwards)
    mesh.faces.push_back({first, first + 2, first + 1});
  else
    mesh.faces.push_back({first, first + 1, first + 2});
}

// Looks along z from `centre`.
PosedCamera camera_at(const Eigen::Vector3d& centre, bool wet) {
  PosedCamera posed;
  posed.camera.width = 200;
  posed.camera.height = 160;
  posed.camera.lens = {200, 200, 99.5, 79.5};
  if (wet) posed.camera.port = refractive::FlatPort<double>{{0, 0, 1}, 0.03, 0.01, 1, 1.5, 1.34};
  posed.pose.centre = centre;
  return posed;
}

TEST(FaceSights, CountsTheSideThatIsTurnedToTheCamera) {
  for (const bool wet : {false, true}) {
    Mesh mesh;
    add_face(mesh, 1, 0.1f, true);
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
  Mesh mesh;
  add_face(mesh, 1, 0.1f, true);
  add_face(mesh, 2, 0.1f, true);
  // From far to the side, the first face does not hide the second one.
  const std::vector cameras = {camera_at({0, 0, 0}, true), camera_at({0.6, 0, 0}, true)};
  const FaceSights sights = count_sights(mesh, cameras);
  EXPECT_THAT(sights.front, testing::ElementsAre(1, 1));
}

TEST(FaceSights, FacesOutsideTheImageAndWithoutAreaAreNotSeen) {
  Mesh mesh;
  add_face(mesh, 1, 0.1f, true);
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex.x() += 2;
  mesh.faces.push_back({0, 0, 1});
  const FaceSights sights = count_sights(mesh, std::vector{camera_at({0, 0, 0}, false)});
  EXPECT_THAT(sights.front, testing::ElementsAre(0, 0));
  EXPECT_THAT(sights.back, testing::ElementsAre(0, 0));
}

TEST(FaceSights, GrazingSightsDoNotCountBelowTheLeastCosine) {
  Mesh mesh;
  add_face(mesh, 1, 0.01f, true);
  const std::vector cameras = {camera_at({0.4, 0, 0}, false)};  // cosine 0.93
  EXPECT_THAT(count_sights(mesh, cameras, {.least_cosine = 0.9}).front, testing::ElementsAre(1));
  EXPECT_THAT(count_sights(mesh, cameras, {.least_cosine = 0.95}).front, testing::ElementsAre(0));
}

}  // namespace
}  // namespace axial::geometry
