// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture/faces/split_faces.h"

#include <gtest/gtest.h>

#include <map>

#include "scene/camera_model.h"
#include "texture/painted_room.h"

namespace axial::texture {
namespace {

// The largest error of linear images inside faces that are in an image [px].
double largest_error(const Mesh& mesh, const std::vector<View>& views) {
  double largest = 0;
  for (const View& view : views)
    std::visit(
        [&](const auto& camera) {
          for (const auto& face : mesh.faces) {
            std::array<Eigen::Vector3d, 3> corners;
            std::array<Eigen::Vector2d, 3> pixels;
            bool inside = true;
            for (std::size_t k = 0; k < 3; ++k) {
              corners[k] = mesh.vertices[face[k]].template cast<double>();
              const auto image = camera.project(view.pose.to_camera(corners[k]));
              pixels[k] = image.pixel;
              inside = inside && image.visible && image.pixel.x() > 0 && image.pixel.y() > 0 &&
                       image.pixel.x() < view.camera.width - 1 &&
                       image.pixel.y() < view.camera.height - 1;
            }
            const Eigen::Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            if (!inside || normal.dot(view.pose.centre - corners[0]) <= 0) continue;
            for (const Eigen::Vector3d& w :
                 {Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(1, 1, 0), Eigen::Vector3d(2, 3, 1)}) {
              const Eigen::Vector3d s = w / w.sum();
              const Eigen::Vector3d point =
                  s[0] * corners[0] + s[1] * corners[1] + s[2] * corners[2];
              const Eigen::Vector2d linear = s[0] * pixels[0] + s[1] * pixels[1] + s[2] * pixels[2];
              largest = std::max(
                  largest, (camera.project(view.pose.to_camera(point)).pixel - linear).norm());
            }
          }
        },
        make_camera<double>(view.camera));
  return largest;
}

double area(const Mesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.faces)
    sum += (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm();
  return sum / 2;
}

// The length of edges of one face only.
double border(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (const auto& face : mesh.faces)
    for (std::size_t k = 0; k < 3; ++k) ++uses[std::minmax(face[k], face[(k + 1) % 3])];
  double sum = 0;
  for (const auto& [edge, count] : uses)
    if (count == 1) sum += (mesh.vertices[edge.first] - mesh.vertices[edge.second]).norm();
  return sum;
}

TEST(SplitFaces, ImagesOfFacesBecomeLinear) {
  const test::Room room = test::photograph_room(3);
  Mesh mesh = test::room_mesh();
  const Mesh before = mesh;
  EXPECT_GT(largest_error(test::refined(mesh, 1), room.views), 2);
  const std::size_t added = split_faces(mesh, room.views);
  EXPECT_EQ(mesh.faces.size(), before.faces.size() + added);
  EXPECT_LE(largest_error(mesh, room.views), 0.25);
  EXPECT_LT(mesh.faces.size(), 20'000u);
  // The same surface, joined as before.
  EXPECT_NEAR(area(mesh), area(before), 1e-5 * area(before));
  EXPECT_NEAR(border(mesh), border(before), 1e-4);
  for (std::size_t v = 0; v < before.vertices.size(); ++v)
    EXPECT_EQ(mesh.vertices[v], before.vertices[v]);
}

TEST(SplitFaces, SmallFacesStay) {
  const test::Room room = test::photograph_room(3);
  Mesh mesh = test::refined(test::room_mesh(), 7);
  EXPECT_EQ(split_faces(mesh, room.views), 0u);
}

}  // namespace
}  // namespace axial::texture
