// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud/pinhole_view.h"

#include <gtest/gtest.h>

#include "cloud/pinhole_cameras.h"
#include "cloud/pinhole_resampling.h"

namespace axial::cloud {
namespace {

class View : public EachCamera {};
INSTANTIATE_TEST_SUITE_P(Cameras, View, testing::ValuesIn(cameras()),
                         [](const auto& parameter) { return parameter.param.name; });

TEST_P(View, ShowsAllAtTheResolutionOfTheCentre) {
  const PinholeView view = pinhole_for(model(), kNear, kFar);
  EXPECT_TRUE(view.whole);
  EXPECT_FALSE(view.camera.port.has_value());
  EXPECT_FALSE(view.camera.distortion.has_value());
  EXPECT_NEAR(view.camera.lens.fx / view.camera.lens.fy, model().lens.fx / model().lens.fy, 1e-9);
  const double middle = 2 / (1 / kNear + 1 / kFar);
  std::visit(
      [&](const auto& camera) {
        for (int i = 0; i <= 40; ++i)
          for (const Eigen::Vector2d& at :
               {Eigen::Vector2d(i / 40.0, 0), {i / 40.0, 1}, {0, i / 40.0}, {1, i / 40.0}})
            for (const double depth : {kNear, middle, kFar}) {
              const Eigen::Vector2d pixel(at.x() * model().width - 0.5,
                                          at.y() * model().height - 0.5);
              const Eigen::Vector2d seen =
                  view.camera.lens.pixel(camera.ray(pixel).at(depth) - view.centre);
              // Between the sampled rays a curved edge may reach a little farther.
              EXPECT_GT(seen.minCoeff(), -0.6);
              EXPECT_LT(seen.x(), view.camera.width - 0.4);
              EXPECT_LT(seen.y(), view.camera.height - 0.4);
            }
        const Eigen::Vector2d centre((model().width - 1) / 2.0, (model().height - 1) / 2.0);
        Eigen::Matrix2d size;
        for (int k = 0; k < 2; ++k) {
          const Eigen::Vector2d step = 0.5 * Eigen::Vector2d::Unit(k);
          size.col(k) = view.camera.lens.pixel(camera.ray(centre + step).at(middle) - view.centre) -
                        view.camera.lens.pixel(camera.ray(centre - step).at(middle) - view.centre);
        }
        EXPECT_NEAR(size.determinant(), 1, 1e-3);
      },
      make_camera<double>(model()));
}

TEST(PinholeView, IsItselfOfAPinhole) {
  const CameraModel model = lens_in_air();
  const PinholeView view = pinhole_for(model, kNear, kFar);
  EXPECT_EQ(view.centre, Eigen::Vector3d::Zero());
  EXPECT_EQ(view.camera.width, model.width);
  EXPECT_EQ(view.camera.lens.cx, model.lens.cx);
  // The photograph does not change by a single byte.
  DepthMap map = exact_map(sphere_before_plane(), model, tilted_pose());
  cv::Mat3b photograph(model.height, model.width);
  cv::randu(photograph, 0, 255);
  const cv::Mat1f surface = render_surface(map, view);
  const PinholeImage image = resampled(photograph, {}, model, view, surface, filled(surface, 1.0f));
  EXPECT_EQ(cv::norm(image.color, photograph, cv::NORM_INF), 0);
}

TEST(PinholeView, OfAFisheyeIsCutAndSaysSo) {
  CameraModel model = lens_in_air();
  model.lens = {80, 80, 119.5, 89.5};
  refractive::LensDistortion<double> fisheye;
  fisheye.fisheye = 1;
  model.distortion = fisheye;
  const PinholeView view = pinhole_for(model, kNear, kFar);
  EXPECT_FALSE(view.whole);
  EXPECT_LE(view.camera.width, 1.4 * model.width + 1);
  EXPECT_LE(view.camera.height, 1.4 * model.height + 1);
}

}  // namespace
}  // namespace axial::cloud
