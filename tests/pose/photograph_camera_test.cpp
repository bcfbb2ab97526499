// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/bundle/photograph_camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "pose/survey.h"

namespace axial::pose {
namespace {

using testing::dome_port;
using testing::flat_port;

lens::Lens lens_of_model(const char* model, std::vector<double> distortion) {
  return {lens::find_model(model), {610, 615, 511.5, 383.5}, std::move(distortion), 1024, 768};
}

std::vector<HousedCamera> housed_cameras() {
  std::vector<HousedCamera> cameras;
  for (const lens::Lens& lens :
       {lens_of_model("PINHOLE", {}), lens_of_model("OPENCV", {-0.12, 0.02, 1e-3, -2e-3}),
        lens_of_model("OPENCV_FISHEYE", {0.02, -0.01, 0.002, 0}),
        lens_of_model("RAD_TAN_THIN_PRISM_FISHEYE",
                      {0.02, -0.01, 0, 0, 0, 0, 1e-3, 2e-3, 1e-3, 0, -1e-3, 0}),
        lens_of_model("EUCM", {0.6, 1.1})}) {
    cameras.push_back({lens});
    cameras.push_back({lens, flat_port(3)});
    cameras.push_back({lens, dome_port()});
  }
  return cameras;
}

TEST(PhotographCamera, ImagesTheRayOfAPixelAtThePixel) {
  for (const HousedCamera& housed : housed_cameras()) {
    const PhotographCamera camera(housed);
    for (double x = 0; x <= 1023; x += 93)
      for (double y = 0; y <= 767; y += 59) {
        const auto ray = camera.ray({x, y});
        ASSERT_NEAR(ray.direction.norm(), 1, 1e-12);
        const PhotographImage image = camera.image(ray.at(2.5));
        ASSERT_TRUE(image.visible) << housed.lens.model->name << " " << x << " " << y;
        EXPECT_LT((image.pixel - Eigen::Vector2d(x, y)).norm(), 1e-8) << housed.lens.model->name;
        EXPECT_LT((image.origin - ray.origin).norm(), 1e-9);
      }
  }
}

// SIMPLE_RADIAL with k = -0.5 folds back at sqrt(2/3). The direction (1, 0, 1) would have an image
// inside the photograph.
TEST(PhotographCamera, DoesNotSeeBeyondTheFoldOfItsLens) {
  const PhotographCamera camera({lens_of_model("SIMPLE_RADIAL", {-0.5})});
  const double fold = std::sqrt(2.0 / 3);
  EXPECT_TRUE(camera.image({fold - 1e-3, 0, 1}).visible);
  EXPECT_FALSE(camera.image({fold + 1e-3, 0, 1}).visible);
  EXPECT_FALSE(camera.image({1, 0, 1}).visible);
  const double edge = 511.5 + 610 * fold * 2 / 3;
  EXPECT_TRUE(camera.ray({edge - 1, 383.5}).direction.allFinite());
  EXPECT_TRUE(camera.ray({edge + 1, 383.5}).direction.hasNaN());
}

TEST(PhotographCamera, SeesAlmostSidewaysThroughAFisheye) {
  const double angle = 89 * std::numbers::pi / 180;
  lens::Lens fisheye = lens_of_model("FISHEYE", {});
  fisheye.pinhole.fx = fisheye.pinhole.fy = 320;
  for (const std::optional<refractive::Port<double>>& port :
       {std::optional<refractive::Port<double>>(), {dome_port()}}) {
    const PhotographCamera camera({fisheye, port});
    const Eigen::Vector2d pixel(511.5 + 320 * angle, 383.5);
    const auto ray = camera.ray(pixel);
    const PhotographImage image = camera.image(ray.at(1));
    ASSERT_TRUE(image.visible);
    EXPECT_LT((image.pixel - pixel).norm(), 1e-6);
  }
}

// The margin is an eighth of the longer side.
TEST(PhotographCamera, SeesALittleBeyondThePhotograph) {
  const PhotographCamera camera({lens_of_model("OPENCV", {-0.12, 0.02, 0, 0})});
  const auto seen = [&](double x) { return camera.image(camera.ray({x, 383.5}).at(1)).visible; };
  EXPECT_TRUE(seen(-127));
  EXPECT_FALSE(seen(-129));
  EXPECT_TRUE(seen(1150));
  EXPECT_FALSE(seen(1152));
}

}  // namespace
}  // namespace axial::pose
