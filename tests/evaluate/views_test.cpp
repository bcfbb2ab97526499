// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/views.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "evaluate/shapes.h"
#include "geometry/sampling.h"
#include "worlds/ports.h"

namespace axial::evaluate {
namespace {

// A camera at `centre` that looks along +z, with 200 x 100 pixels and a field 90 degrees wide.
View camera_at(const Eigen::Vector3d& centre) {
  return {test::camera_at(centre, 200, 100, 100)};
}

refractive::FlatPort<double> port() {
  return {{0, 0, 1}, 0.03, 0.018, 1, 1.49, 1.333};
}

std::uint32_t views_of(const Eigen::Vector3d& point, const std::vector<View>& views,
                       const geometry::Surface& surface) {
  const std::vector<Eigen::Vector3f> points{point.cast<float>()};
  return count_views(points, views, surface)[0];
}

TEST(CountViews, KeepsToTheImageRectangle) {
  const geometry::Surface floor(flat_square(6, 1));
  const std::vector<View> views{camera_at({0, 0, 0})};
  EXPECT_EQ(views_of({0, 0, 1}, views, floor), 1u);
  EXPECT_EQ(views_of({0.99, 0.49, 1}, views, floor), 1u);
  EXPECT_EQ(views_of({1.01, 0, 1}, views, floor), 0u);
  EXPECT_EQ(views_of({0, -0.51, 1}, views, floor), 0u);
  EXPECT_EQ(views_of({0, 0, -1}, views, floor), 0u) << "behind the camera";
}

TEST(CountViews, APlateHidesWhatLiesInItsShadow) {
  Mesh mesh = flat_square(6, 2);
  const Mesh plate = flat_square(0.5, 1);  // half extent 0.25, half way: its shadow reaches 0.5
  append(mesh, plate);
  const geometry::Surface surface(mesh);
  const std::vector<View> views{camera_at({0, 0, 0}), camera_at({1, 0, 0})};
  EXPECT_EQ(views_of({0.45, 0, 2}, views, surface), 1u) << "hidden from the first view only";
  EXPECT_EQ(views_of({0.55, 0, 2}, views, surface), 2u);
  EXPECT_EQ(views_of({0.1, 0.1, 1}, views, surface), 2u) << "the plate itself";
  EXPECT_EQ(views_of({-0.9, 0, 2}, views, surface), 1u) << "the second view's shadow";
}

TEST(CountFrames, IsTheRectangleAloneInAirAndUnderWater) {
  View wet = camera_at({0, 0, 0});
  wet.camera.port = port();
  const std::vector<View> views{camera_at({0, 0, 0}), wet};
  // At 1 m, a point 0.72 m aside is inside the image in air and outside under water.
  const std::vector<Eigen::Vector3f> points{{0, 0, 1}, {0, 0, 7}, {0.72f, 0, 1}, {1.1f, 0, 1}};
  EXPECT_THAT(count_frames(points, views), testing::ElementsAre(2u, 2u, 1u, 0u));
  const geometry::Surface floor(flat_square(6, 1));  // hides the second point from both cameras
  EXPECT_THAT(count_views(points, views, floor), testing::ElementsAre(2u, 0u, 1u, 0u));
}

TEST(CountViews, WaterNarrowsTheFieldOfView) {
  const geometry::Surface floor(flat_square(6, 1));
  View wet = camera_at({0, 0, 0});
  wet.camera.port = port();
  // The edge of the image: the ray of u = -0.5, v = 49.5 in closed form by Snell's law.
  const double s = 1.0;  // tan^2 of 45 degrees
  const double q_g = std::sqrt(1.49 * 1.49 + (1.49 * 1.49 - 1) * s);
  const double q_w = std::sqrt(1.333 * 1.333 + (1.333 * 1.333 - 1) * s);
  const double edge = 0.03 + 0.018 / q_g + (1 - 0.048) / q_w;
  EXPECT_LT(edge, 0.7) << "in air it is 1";
  EXPECT_EQ(views_of({-edge + 1e-4, 0, 1}, {wet}, floor), 1u);
  EXPECT_EQ(views_of({-edge - 1e-4, 0, 1}, {wet}, floor), 0u);
}

TEST(CountViews, TheLineOfSightInWaterEndsAtThePort) {
  Mesh mesh = flat_square(6, 1);
  // A small plate between the lens and the port hides nothing. The same plate in front of the port
  // hides the point.
  for (const double z : {0.02, 0.1}) {
    Mesh scene = mesh;
    append(scene, flat_square(0.5, z));
    View wet = camera_at({0, 0, 0});
    wet.camera.port = port();
    EXPECT_EQ(views_of({0.1, 0.1, 1}, {wet}, geometry::Surface(scene)), z < 0.05 ? 1u : 0u) << z;
  }
}

TEST(PixelWidths, AreDistanceOverFocalLengthInTheMeanOfTheViewsThatSee) {
  const geometry::Surface floor(flat_square(6, 2));
  // Cameras 2 m and 1 m above the floor, focal length 100 px.
  const std::vector<View> views{camera_at({0, 0, 0}), camera_at({0, 0, 1})};
  const std::vector<Eigen::Vector3f> points{{0, 0, 2}, {1.5f, 0, 2}, {2.9f, 0, 2}};
  const auto widths = pixel_widths(points, views, floor);
  EXPECT_NEAR(widths[0], 0.015, 1e-6) << "of both";
  // Off the axis 1 + x^2/z^2 = 1.25^2: across the ray a pixel is narrower than z/f by the factor
  // 1.25 in u, but not in v.
  EXPECT_NEAR(widths[1], 0.02 / std::sqrt(1.25), 1e-5) << "of the farther one alone";
  EXPECT_EQ(widths[2], 0.0f) << "of none";
}

io::ColmapModel small_model(const std::string& lens, std::vector<double> parameters) {
  io::ColmapModel model;
  model.cameras.push_back({7, lens, 640, 480, std::move(parameters)});
  io::ColmapImage image;
  image.id = 1;
  image.camera = 7;
  image.name = "a.jpg";
  image.pose.centre = {1, 2, 3};
  model.images.push_back(image);
  return model;
}

TEST(ViewsOfModel, TakesLensPoseAndPort) {
  const auto model = small_model("PINHOLE", {500, 510, 320, 240});
  io::Housing housing;
  housing.ports["main"] = port();
  housing.cameras[7] = "main";
  const auto dry = views_of_model(model, nullptr);
  const auto wet = views_of_model(model, &housing);
  ASSERT_EQ(dry.size(), 1u);
  EXPECT_EQ(dry[0].camera.lens.fy, 510);
  EXPECT_EQ(dry[0].camera.lens.cx, 319.5);  // COLMAP's centres are at one half
  EXPECT_FALSE(dry[0].camera.port.has_value());
  ASSERT_TRUE(wet[0].camera.port.has_value());
  EXPECT_EQ(std::get<refractive::FlatPort<double>>(*wet[0].camera.port).thickness, 0.018);
  EXPECT_EQ(wet[0].pose.centre, Eigen::Vector3d(1, 2, 3));
}

TEST(ViewsOfModel, KeepsADistortedLens) {
  const auto views =
      views_of_model(small_model("OPENCV", {500, 510, 320, 240, -0.1, 0, 0, 0}), nullptr);
  ASSERT_TRUE(views[0].camera.distortion);
  EXPECT_EQ(views[0].camera.distortion->above[1], -0.1);
  EXPECT_EQ(views[0].camera.lens.cx, 319.5);
}

TEST(ViewsOfModel, SeesAWaterSurfaceFromEachPose) {
  auto model = small_model("PINHOLE", {500, 510, 320, 240});
  model.images.push_back(model.images[0]);
  model.images[1].name = "b.jpg";
  model.images[1].pose.centre.z() = 1;
  io::Housing housing;
  housing.ports["lake"] = WaterSurface{{0, 0, 1}, {0, 0, 3.5}, 1, 1.333};
  housing.default_port = "lake";
  const auto views = views_of_model(model, &housing);
  const auto distance = [&](std::size_t i) {
    return std::get<refractive::FlatPort<double>>(*views[i].camera.port).distance;
  };
  EXPECT_EQ(distance(0), 0.5);
  EXPECT_EQ(distance(1), 2.5);
  model.images[1].pose.centre.z() = 4;
  EXPECT_THROW(views_of_model(model, &housing), Error);
}

TEST(ViewsOfModel, FindsPortsByTheEndOfTheName) {
  auto model = small_model("PINHOLE", {500, 510, 320, 240});
  model.images[0].name = "dive2/left/a.jpg";
  io::Housing housing;
  housing.ports["main"] = port();
  housing.images = {{"a.jpg", "none"}, {"left/a.jpg", "main"}, {"t/a.jpg", "none"}};
  EXPECT_TRUE(views_of_model(model, &housing)[0].camera.port.has_value());
}

TEST(ViewsOfModel, RefusesLensesThatAreNotMatchedAsTheyAreAndEmptyModels) {
  std::vector<double> parameters{500, 500, 320, 240};
  parameters.resize(16, 1e-3);
  EXPECT_THROW(views_of_model(small_model("RAD_TAN_THIN_PRISM_FISHEYE", parameters), nullptr),
               Error);
  EXPECT_THROW(views_of_model(io::ColmapModel{}, nullptr), Error);
}

}  // namespace
}  // namespace axial::evaluate
