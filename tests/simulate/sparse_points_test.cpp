// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/sparse_points.h"

#include <gtest/gtest.h>

#include "simulate/presets/presets.h"
#include "simulate/solid_texture.h"

namespace axial::simulate {
namespace {

TEST(SparsePoints, LieOnTheSurfaceWhereTheyAreObserved) {
  Preset preset = make_preset({"closeup", 2, 0, 320, 240, 80});
  preset.terrain.cell *= 4;
  const TriangleMesh mesh = terrain_mesh(preset.terrain);
  const RayScene scene(mesh);
  const auto points = true_points(scene, seabed_shader(mesh, scene, preset.texture), preset.lens,
                                  preset.views, 50, 1);
  EXPECT_GT(points.size(), 300u);
  std::size_t observations = 0, hidden = 0;
  for (const SparsePoint& point : points) {
    ASSERT_GE(point.observations.size(), 2u);
    for (const Observation& seen : point.observations) {
      const View& view = preset.views[seen.view];
      const SceneRay ray =
          to_world(view, *trace_pixel(preset.lens, nullptr, seen.pixel.x(), seen.pixel.y()));
      const auto hit = scene.first_hit(ray.start, ray.direction);
      ASSERT_TRUE(hit);
      const double distance = (point.position - view.centre).norm();
      ++observations;
      // A surface that is nearer by at most a thousandth does not count as occluding.
      EXPECT_NEAR(hit->distance, distance, 1.01e-3 * distance);
      if (std::abs(hit->distance - distance) > 1e-6 * distance) ++hidden;
    }
  }
  // Only points directly beside an occluding edge may be off by more than rounding.
  EXPECT_LT(100 * hidden, observations);
}

TEST(SparsePoints, AreNotSeenThroughWhatIsInFront) {
  // A wall at 2 m, and a small plate at 1 m that hides the middle of the wall from the first view
  // only.
  const TriangleMesh mesh{{{-9, -9, 2},
                           {9, -9, 2},
                           {9, 9, 2},
                           {-9, 9, 2},
                           {-.2f, -.2f, 1},
                           {.2f, -.2f, 1},
                           {.2f, .2f, 1},
                           {-.2f, .2f, 1}},
                          {{0, 2, 1}, {0, 3, 2}, {4, 6, 5}, {4, 7, 6}}};
  const RayScene scene(mesh);
  const std::vector<View> views = {View{}, {Eigen::Matrix3d::Identity(), {0.5, 0, 0}}};
  const Shader white = [](const SurfacePoint&) { return Eigen::Vector3f::Ones().eval(); };
  int on_wall = 0;
  for (const SparsePoint& point :
       true_points(scene, white, make_lens(200, 150, 80), views, 400, 1)) {
    ASSERT_EQ(point.observations.size(), 2u);
    if (point.position.z() < 1.5) continue;
    ++on_wall;
    const auto hidden_from = [&](double camera_x) {
      const double x = 0.5 * (point.position.x() + camera_x), y = 0.5 * point.position.y();
      return std::abs(x) < 0.199 && std::abs(y) < 0.199;
    };
    EXPECT_FALSE(hidden_from(0) || hidden_from(0.5)) << point.position.transpose();
  }
  EXPECT_GT(on_wall, 100);
}

}  // namespace
}  // namespace axial::simulate
