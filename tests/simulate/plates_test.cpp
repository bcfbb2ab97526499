// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/plates.h"

#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <cmath>

#include "base/error.h"
#include "simulate/presets/presets.h"
#include "support/error_of.h"

namespace axial::simulate {
namespace {

// A small reef with coarse cells, and plates on it.
class Plates : public testing::Test {
 protected:
  Preset preset_ = [] {
    PresetOptions options;
    options.coarseness = 4;
    options.width = 320;
    options.height = 240;
    options.views = 4;
    return make_preset(options);
  }();
  TriangleMesh ground_ = terrain_mesh(preset_.terrain);
  RayScene scene_{ground_};
  std::vector<Plate> plates_ =
      lay_plates(scene_, preset_.lens, preset_.views, {5, {0.5, 0.3}, 0.1, 3});
};

TEST_F(Plates, BarsHaveTheirLengthsAndLieInOnePlane) {
  ASSERT_EQ(plates_.size(), 9u);
  for (const auto& [first, length] : {std::pair{5u, 0.5}, {7u, 0.3}}) {
    const Plate &a = plates_[first], &b = plates_[first + 1];
    EXPECT_NEAR((a.centre - b.centre).norm(), length, 1e-12);
    EXPECT_NEAR(a.axes.col(2).dot(a.centre - b.centre), 0, 1e-12);
    EXPECT_TRUE(a.axes.isApprox(b.axes));
  }
}

TEST_F(Plates, LieOnTheGroundWithoutATouch) {
  for (const Plate& plate : plates_) {
    EXPECT_TRUE((plate.axes.transpose() * plate.axes).isIdentity(1e-12));
    EXPECT_NEAR(plate.axes.determinant(), 1, 1e-12);
    EXPECT_LT(plate.axes(2, 2), 0) << "the pattern is above";
    double lowest = 1;
    for (double x = -1; x <= 1; x += 0.25)
      for (double y = -1; y <= 1; y += 0.25) {
        const Eigen::Vector3d place =
            plate.centre + plate.side / 2 * (x * plate.axes.col(0) + y * plate.axes.col(1));
        const auto hit = scene_.first_hit(place, -Eigen::Vector3d::UnitZ());
        ASSERT_TRUE(hit) << "the ground is above the plate";
        lowest = std::min(lowest, hit->distance);
      }
    EXPECT_LT(lowest, 0.05) << "the plate floats";
    for (const Plate& other : plates_)
      if (&other != &plate) {
        EXPECT_GT((other.centre - plate.centre).norm(), plate.side * std::sqrt(2.0));
      }
  }
}

TEST_F(Plates, RaysOfTheImageOfAPlateMeetItsCentre) {
  append(ground_, plate_mesh(plates_));
  const RayScene scene(ground_);
  int seen = 0;
  for (const View& view : preset_.views)
    for (const Plate& plate : plates_)
      for (const Port* port :
           {static_cast<const Port*>(nullptr), static_cast<const Port*>(&preset_.port)})
        if (const auto image = image_of(plate, scene, preset_.lens, port, view)) {
          ++seen;
          const SceneRay ray = to_world(
              view, *trace_pixel(preset_.lens, port, image->centre.x(), image->centre.y()));
          const Eigen::Vector3d to_centre = plate.centre - ray.start;
          EXPECT_LT(to_centre.cross(ray.direction).norm(), 1e-9);
          EXPECT_NEAR(std::cos(image->oblique), ray.direction.dot(plate.axes.col(2)), 1e-9);
          // A small part of a sphere around a pinhole.
          const Eigen::Vector3d offset = plate.centre - view.centre;
          const double off_axis = (view.rotation * offset).z() / offset.norm();
          const double expected = preset_.lens.focal * plate.side / offset.norm() *
                                  std::sqrt(std::cos(image->oblique) / std::pow(off_axis, 3));
          EXPECT_GT(image->width / expected, port ? 1.3 : 0.98);
          EXPECT_LT(image->width / expected, port ? 2 : 1.02);  // stretched at the rim
          const auto hit = scene.first_hit(ray.start, ray.direction);
          ASSERT_TRUE(hit);
          EXPECT_LT((ray.start + hit->distance * ray.direction - plate.centre).norm(), 1e-5);
        }
  EXPECT_GT(seen, 20);
}

TEST_F(Plates, PlacesOnAPlateAreOnTheRaysOfTheirPixels) {
  const std::vector<Eigen::Vector2d> places{{0.5, -0.25}, {-1, 1}};
  int seen = 0;
  for (const View& view : preset_.views)
    for (const Plate& plate : plates_)
      if (const auto pixels = pixels_of(plate, places, preset_.lens, &preset_.port, view))
        for (std::size_t i = 0; i < places.size(); ++i, ++seen) {
          const SceneRay ray = to_world(
              view, *trace_pixel(preset_.lens, &preset_.port, (*pixels)[i].x(), (*pixels)[i].y()));
          const Eigen::Vector3d in_plate(places[i].x() * plate.side / 2,
                                         places[i].y() * plate.side / 2, 0);
          const Eigen::Vector3d place = plate.centre + plate.axes * in_plate;
          EXPECT_LT((place - ray.start).cross(ray.direction).norm(), 1e-9);
        }
  EXPECT_GT(seen, 20);
}

TEST_F(Plates, ACoveredPartHidesAPlate) {
  const Plate& plate = plates_[0];
  Plate stone = plate;  // covers a sixteenth of the plate, but no corner
  stone.centre += plate.side * (0.25 * plate.axes.col(0) - 0.02 * plate.axes.col(2));
  stone.side = plate.side / 4;
  int seen = 0;
  for (const bool covered : {false, true}) {
    TriangleMesh mesh = ground_;
    append(mesh, plate_mesh(std::span(&plate, 1)));
    if (covered) append(mesh, plate_mesh(std::span(&stone, 1)));
    const RayScene scene(mesh);
    for (const View& view : preset_.views)
      if (image_of(plate, scene, preset_.lens, &preset_.port, view)) {
        ++seen;
        EXPECT_FALSE(covered);
      }
  }
  EXPECT_GT(seen, 0);
}

TEST_F(Plates, TheShaderShowsThePatternOnTheUpperSideOnly) {
  const std::vector<Plate> one{{Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(1, -1, -1).asDiagonal(),
                                0.2, [](double x, double y) { return x > 0 && y > 0; }}};
  const Shader shader =
      with_plates([](const SurfacePoint&) { return Eigen::Vector3f(7, 7, 7); }, one, 100, 3);
  const auto light = [&](double x, double y, std::uint32_t face) {
    SurfacePoint point{{x, y, 3}, {}, 1e-6};
    point.hit.face = face;
    return shader(point).x();
  };
  EXPECT_EQ(light(1, 2, 99), 7);
  EXPECT_GT(light(1.05, 1.95, 100), 0.5);  // right, and down in the pattern
  EXPECT_LT(light(1.05, 2.05, 101), 0.1);
  EXPECT_LT(light(1.05, 1.95, 102), 0.1);  // a side of the slab
}

TEST_F(Plates, TooShortBarsAndTooLargePlatesAreRefused) {
  EXPECT_THAT(test::error_of([&] {
                lay_plates(scene_, preset_.lens, preset_.views, {0, {0.15}, 0.1, 3});
              }),
              testing::HasSubstr("a bar of 0.15 m is too short"));
  EXPECT_THAT(test::error_of([&] {
                lay_plates(scene_, preset_.lens, preset_.views, {1, {}, 9, 3});
              }),
              testing::HasSubstr("no level ground for plate 1 of 9 m"));
}

}  // namespace
}  // namespace axial::simulate
