// SPDX-License-Identifier: GPL-3.0-or-later
// Which pixels are at borders, compared with projections in double precision, for every kind of
// camera.
#include "depth/border.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <numbers>
#include <vector>

#include "support/analytic_scene.h"

namespace axial::depth {
namespace {

// A reference view and its source views.
struct Views {
  Views(const CameraModel& camera, std::size_t sources) {
    const std::vector<Pose> poses = test::circle_of_poses(sources + 1, 0.1);
    for (const Pose& pose : poses)
      images.push_back({0, camera, pose, cv::Mat1b(camera.height, camera.width, std::uint8_t{0})});
    for (std::size_t i = 1; i < images.size(); ++i) source_views.push_back(&images[i]);
    map = test::exact_map(test::AnalyticScene(), camera, poses[0]);
  }

  MatchInput input() const { return {&images[0], source_views, {}, nullptr}; }

  std::vector<MatchImage> images;
  std::vector<const MatchImage*> source_views;
  DepthMap map;
};

// The number of source views that show the surface point of a pixel at least `margin` pixels inside
// the image.
int views_that_show(const Views& views, int x, int y, double margin) {
  const DepthMap& map = views.map;
  const auto ray = std::visit([&](const auto& camera) { return camera.ray(Eigen::Vector2d(x, y)); },
                              make_camera<double>(map.camera));
  const Eigen::Vector3d point = map.pose.to_world(ray.at(static_cast<double>(map.depth(y, x))));
  const auto shows = [&](const MatchImage& source) {
    return std::visit(
        [&](const auto& camera) {
          const auto image = camera.project(source.pose.to_camera(point));
          return image.visible && image.pixel.x() >= margin && image.pixel.y() >= margin &&
                 image.pixel.x() <= source.grey.cols - 1 - margin &&
                 image.pixel.y() <= source.grey.rows - 1 - margin;
        },
        make_camera<double>(source.camera));
  };
  int count = 0;
  for (const MatchImage* source : views.source_views) count += shows(*source) ? 1 : 0;
  return count;
}

int distance_to_border(int x, int y, const cv::Mat1b& image) {
  return std::min({x, y, image.cols - 1 - x, image.rows - 1 - y});
}

class Borders : public ::testing::TestWithParam<CameraModel> {};

// A pixel shares the projection of the first pixel of its block, at most kBorderBlock - 1 pixels
// away in each direction. In these scenes the source image shows both at nearly the same distance.
// Pixels this near to the limit may go either way.
constexpr double kBlock = std::numbers::sqrt2 * (kBorderBlock - 1) + 0.5;

TEST_P(Borders, AreNearTheReferencesBorderOrThoseOfAllSources) {
  const Views views(GetParam(), 2);
  const cv::Mat1b border = border_pixels(views.input(), views.map);
  int of_reference = 0, of_sources = 0, inside = 0;
  for (int y = 0; y < border.rows; ++y)
    for (int x = 0; x < border.cols; ++x) {
      if (distance_to_border(x, y, border) < kBorderWidth) {
        EXPECT_EQ(border(y, x), 255) << x << " " << y;
        ++of_reference;
      } else if (views_that_show(views, x, y, kBorderWidth + kBlock) > 0) {
        EXPECT_EQ(border(y, x), 0) << x << " " << y;
        ++inside;
      } else if (views_that_show(views, x, y, kBorderWidth - kBlock) == 0) {
        EXPECT_EQ(border(y, x), 255) << x << " " << y;
        ++of_sources;
      }
    }
  EXPECT_GT(of_reference, 1000);
  EXPECT_GT(of_sources, 20);
  EXPECT_GT(inside, border.cols * border.rows / 4);
}

TEST_P(Borders, PixelsWithoutADepthAreNot) {
  Views views(GetParam(), 2);
  views.map.depth = 0.0f;
  EXPECT_EQ(cv::countNonZero(border_pixels(views.input(), views.map)), 0);
}

TEST_P(Borders, OneSourceViewAwayFromItsBorderIsEnough) {
  const Views two(GetParam(), 2), five(GetParam(), 5);
  EXPECT_LT(cv::countNonZero(border_pixels(five.input(), five.map)),
            cv::countNonZero(border_pixels(two.input(), two.map)));
  // The reference view as its own source view: no pixel is nearer to a border there.
  Views same = two;
  same.source_views = {&same.images[0]};
  const cv::Mat1b border = border_pixels(same.input(), same.map);
  for (int y = 0; y < border.rows; ++y)
    for (int x = 0; x < border.cols; ++x) {
      // Near the limit, the first pixel of the block decides.
      const int distance = distance_to_border(x, y, border);
      if (std::abs(distance - kBorderWidth) < kBorderBlock) continue;
      EXPECT_EQ(border(y, x) != 0, distance < kBorderWidth) << x << " " << y;
    }
}

CameraModel with_lens(CameraModel camera) {
  refractive::LensDistortion<double> distortion;
  distortion.above[1] = -0.1;
  camera.distortion = distortion;
  return camera;
}

INSTANTIATE_TEST_SUITE_P(, Borders,
                         ::testing::Values(test::dry_camera(),
                                           test::behind_port(test::dry_camera()),
                                           test::behind_port(with_lens(test::dry_camera()))));

}  // namespace
}  // namespace axial::depth
