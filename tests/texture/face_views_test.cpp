// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture/faces/face_views.h"

#include <gtest/gtest.h>

#include "scene/camera_model.h"
#include "texture/faces/outliers.h"
#include "texture/painted_room.h"

namespace axial::texture {
namespace {

// The simulator looks from the point where the light of a face's middle leaves the port, which it
// finds by its own tracing: on the pixel's ray the first face must be the seen one.
TEST(FaceViews, SeenFacesAreTheFirstOnTheirRays) {
  const test::Room room = test::photograph_room(4);
  const Mesh mesh = test::refined(test::room_mesh(), 4);
  const FaceViews seen = find_face_views(mesh, room.views, room.source());
  const simulate::RayScene scene({mesh.vertices, mesh.faces});
  const simulate::Lens lens = simulate::make_lens(240, 180, 65);
  const simulate::Port port = test::room_port();
  std::size_t checked = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (const Sight& sight : seen.of(f)) {
      const View& view = room.views[sight.view];
      Eigen::Vector3d middle = Eigen::Vector3d::Zero();
      for (const std::uint32_t corner : mesh.faces[f])
        middle += mesh.vertices[corner].cast<double>() / 3;
      const Eigen::Vector2d pixel = std::visit(
          [&](const auto& camera) -> Eigen::Vector2d {
            return camera.project(view.pose.to_camera(middle)).pixel;
          },
          make_camera<double>(view.camera));
      const auto ray = simulate::trace_pixel(lens, &port, pixel.x(), pixel.y());
      ASSERT_TRUE(ray);
      const auto in_world = simulate::to_world({view.pose.rotation, view.pose.centre}, *ray);
      const auto hit = scene.first_hit(in_world.start, in_world.direction);
      ASSERT_TRUE(hit);
      EXPECT_EQ(hit->face, f);
      ++checked;
    }
  EXPECT_GT(checked, 3000u);
}

TEST(FaceViews, QualityIsHigherForNearerAndMoreFrontalViews) {
  test::Room room = test::photograph_room(1);
  const auto look = [&](const Eigen::Vector3d& centre) {
    const Eigen::Vector3d z = -centre.normalized();
    const Eigen::Vector3d x = z.unitOrthogonal();
    room.views[0].pose.centre = centre;
    room.views[0].pose.rotation << x.transpose(), z.cross(x).transpose(), z.transpose();
    Mesh mesh{{{-0.05f, -0.05f, 0}, {0.05f, -0.05f, 0}, {0, 0.05f, 0}}, {}, {{0, 1, 2}}};
    const FaceViews seen = find_face_views(mesh, room.views, room.source());
    return seen.sights.empty() ? 0 : seen.sights[0].quality;
  };
  const float frontal = look({0, 0, 1}), farther = look({0, 0, 2}), oblique = look({0.8, 0, 0.6});
  // The area falls with the square of the distance, up to the port's 4 cm; an oblique view has the
  // area times the cosine 0.6, and the square of the cosine.
  EXPECT_NEAR(frontal / farther, 4, 0.3);
  EXPECT_NEAR(oblique / frontal, 0.6 * 0.6 * 0.6, 0.03);
  EXPECT_EQ(look({0, 0, -1}), 0);  // from behind
}

TEST(Outliers, OneStrangeColourOfSixIsRemoved) {
  FaceViews views;
  views.begin = {0, 6, 10};
  const auto add = [&](std::uint32_t view, std::uint8_t grey) {
    views.sights.push_back({view, 1, {grey, grey, grey}, true});
  };
  for (std::uint32_t v = 0; v < 6; ++v) add(v, v == 2 ? 200 : static_cast<std::uint8_t>(90 + v));
  for (std::uint32_t v = 0; v < 4; ++v) add(v, v == 2 ? 200 : 90);  // too few to tell
  EXPECT_EQ(remove_outliers(views, 0), 0u);
  EXPECT_EQ(remove_outliers(views, 0.06), 1u);
  ASSERT_EQ(views.of(0).size(), 5u);
  EXPECT_EQ(views.of(0)[2].view, 3u);
  EXPECT_EQ(views.of(1).size(), 4u);
}

}  // namespace
}  // namespace axial::texture
