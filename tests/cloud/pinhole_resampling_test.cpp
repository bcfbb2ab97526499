// SPDX-License-Identifier: GPL-3.0-or-later
// Compares photographs and depth maps resampled to a pinhole with surfaces known in closed form.
#include "cloud/pinhole_resampling.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/parallel.h"
#include "cloud/pinhole_cameras.h"
#include "cloud/pinhole_view.h"
#include "support/error_of.h"
#include "support/textured_scene.h"

namespace axial::cloud {
namespace {

// The point [world] of the surface that a pinhole with this camera and pose sees at `pixel`.
std::optional<Eigen::Vector3d> surface_at(const AnalyticScene& scene, const CameraModel& pinhole,
                                          const Pose& pose, const Eigen::Vector2d& pixel) {
  const Eigen::Vector3d direction =
      pose.rotation.transpose() * pinhole.lens.bearing(pixel).normalized();
  const auto hit = scene.hit(pose.centre, direction);
  if (!hit) return {};
  return pose.centre + hit->lambda * direction;
}

// The cameras see smooth surfaces and few edges, so every third pixel in each direction shows their
// errors, and edges of one pixel are met at many places.
constexpr int kPixelStep = 3;

struct Errors {
  double mean = 0, largest = 0;
  std::size_t pixels = 0, of_field = 0;

  double share() const { return static_cast<double>(pixels) / static_cast<double>(of_field); }
};

// For each kPixelStep-th pixel of the pinhole with a surface, compares the pixel at which the
// photograph is sampled with the exact image of the surface point. Includes pixels at silhouettes.
Errors lookup_errors(const AnalyticScene& scene, const CameraModel& photograph, const DepthMap& map,
                     const PinholeView& view, const cv::Mat1f& inverse) {
  const Pose pinhole = view.pose(map.pose);
  const cv::Mat2f places = seen_by(photograph, view, inverse, {0, inverse.rows});
  Errors errors;
  std::visit(
      [&](const auto& camera) {
        for (int y = 0; y < inverse.rows; y += kPixelStep)
          for (int x = 0; x < inverse.cols; x += kPixelStep) {
            const auto X = surface_at(scene, view.camera, pinhole, {x, y});
            if (!X) continue;
            const auto seen = camera.project(map.pose.to_camera(*X));
            const bool in_field = seen.visible && seen.pixel.minCoeff() > 0 &&
                                  seen.pixel.x() < photograph.width - 1 &&
                                  seen.pixel.y() < photograph.height - 1;
            errors.of_field += in_field ? 1 : 0;
            if (inverse(y, x) == 0 || !seen.visible) continue;
            const Eigen::Vector2d place =
                Eigen::Vector2f(places(y, x)[0], places(y, x)[1]).cast<double>();
            const double error = (place - seen.pixel).norm();
            errors.mean += error;
            errors.largest = std::max(errors.largest, error);
            ++errors.pixels;
          }
      },
      make_camera<double>(photograph));
  errors.mean /= static_cast<double>(std::max<std::size_t>(errors.pixels, 1));
  return errors;
}

class Resampling : public EachCamera {
 protected:
  // For properties that do not depend on the size of a pixel.
  static CameraModel small() { return model().resized(120, 90); }
};
INSTANTIATE_TEST_SUITE_P(Cameras, Resampling, testing::ValuesIn(cameras()),
                         [](const auto& parameter) { return parameter.param.name; });

TEST_P(Resampling, LooksUpTheImageOfTheSurface) {
  for (const AnalyticScene& scene : {plane(), sphere_before_plane()})
    for (const int scale : {1, 2, 5}) {
      const CameraModel small = model().resized(model().width / scale, model().height / scale);
      const DepthMap map = exact_map(scene, small, tilted_pose());
      const PinholeView view = pinhole_for(model(), kNear, kFar);
      const Errors errors = lookup_errors(scene, model(), map, view, render_surface(map, view));
      const std::string what =
          fmt::format("scale {} sphere {} largest {:.4f} mean {:.5f} share {}", scale,
                      scene.sphere_radius, errors.largest, errors.mean, errors.share());
      RecordProperty(fmt::format("scale{}_sphere{}", scale, scene.sphere_radius > 0), what);
      EXPECT_LT(errors.largest, 0.3) << what;
      EXPECT_LT(errors.mean, 0.01) << what;
      // Pixels without a surface are at steps in depth, at surfaces that only the pinhole sees, and
      // at the map's edge (half a pixel of the map).
      EXPECT_GT(errors.share(), scale == 5 ? 0.9 : 0.94) << what;
    }
}

// The pixels around the pinhole's image of a point are sampled around the camera's observation of
// the point.
TEST_P(Resampling, TakesObservationsAlong) {
  const AnalyticScene scene = sphere_before_plane();
  const DepthMap map = exact_map(scene, small(), tilted_pose());
  const PinholeView view = pinhole_for(model(), kNear, kFar);
  const cv::Mat1f inverse = render_surface(map, view);
  const cv::Mat2f places = seen_by(model(), view, inverse, {0, inverse.rows});
  std::size_t checked = 0;
  std::visit(
      [&](const auto& camera) {
        for (int i = 0; i < 2000; ++i) {
          const Eigen::Vector2d observation(std::fmod(i * 37.31, 240.0),
                                            std::fmod(i * 11.7, 180.0));
          const auto ray = camera.ray(observation);
          const auto hit = scene.hit(map.pose.to_world(ray.origin),
                                     map.pose.rotation.transpose() * ray.direction);
          if (!hit) continue;
          const Eigen::Vector2d at = view.camera.lens.pixel(ray.at(hit->lambda) - view.centre);
          const int u = static_cast<int>(std::floor(at.x())),
                    v = static_cast<int>(std::floor(at.y()));
          if (u < 0 || v < 0 || u + 1 >= inverse.cols || v + 1 >= inverse.rows) continue;
          if (cv::countNonZero(inverse(cv::Rect(u, v, 2, 2))) < 4) continue;
          const auto [least, most] = std::minmax(
              {inverse(v, u), inverse(v, u + 1), inverse(v + 1, u), inverse(v + 1, u + 1)});
          if (most > 1.03f * least) continue;  // beside a silhouette
          const auto a = static_cast<float>(at.x() - u), b = static_cast<float>(at.y() - v);
          const cv::Vec2f place = (1 - b) * ((1 - a) * places(v, u) + a * places(v, u + 1)) +
                                  b * ((1 - a) * places(v + 1, u) + a * places(v + 1, u + 1));
          const Eigen::Vector2d taken = Eigen::Vector2f(place[0], place[1]).cast<double>();
          EXPECT_LT((taken - observation).norm(), 0.1) << observation.transpose();
          ++checked;
        }
      },
      make_camera<double>(model()));
  EXPECT_GT(checked, 1000u);
}

// Compares the resampled photograph with a photograph that the pinhole takes of the same scene. The
// difference must be smaller than that of a photograph shifted by 0.3 pixels.
TEST_P(Resampling, GivesThePhotographThatThePinholeWouldTake) {
  const CameraModel tiny = model().resized(80, 60);
  test::TexturedScene scene;
  scene.cell = 0.12;  // 5 pixels: smooth noise that a shift changes
  const Pose pose{tilted_pose().rotation, {0.1, 0.05, 0.9}};
  const test::RenderedView taken = render(scene, tiny, pose);
  DepthMap map;
  map.camera = tiny, map.pose = pose, map.depth = taken.depth;
  const PinholeView view = pinhole_for(tiny, kNear, kFar);
  cv::Mat3b photograph;
  cv::merge(std::vector<cv::Mat>(3, taken.image), photograph);
  const cv::Mat1f surface = render_surface(map, view);
  const PinholeImage image = resampled(photograph, {}, tiny, view, surface, filled(surface, 1.0f));
  const cv::Mat1b truth = render(scene, view.camera, view.pose(pose)).image;
  CameraModel off = view.camera;
  off.lens.cx += 0.3;
  const cv::Mat1b shifted = render(scene, off, view.pose(pose)).image;
  double difference = 0, of_shifted = 0;
  for (int y = 0; y < truth.rows; ++y)
    for (int x = 0; x < truth.cols; ++x)
      if (image.label(y, x) == kExact) {
        difference += std::abs(image.color(y, x)[1] - truth(y, x));
        of_shifted += std::abs(shifted(y, x) - truth(y, x));
      }
  EXPECT_GT(cv::countNonZero(image.label == kExact), 0.7 * static_cast<double>(truth.total()));
  EXPECT_LT(difference, 0.5 * of_shifted);
}

TEST_P(Resampling, PutsTheMapOntoTheSurface) {
  const AnalyticScene scene = sphere_before_plane();
  const DepthMap map = exact_map(scene, model(), tilted_pose());
  const PinholeView view = pinhole_for(model(), kNear, kFar);
  const DepthMap result = resampled(map, view, render_surface(map, view));
  EXPECT_FALSE(result.camera.port);
  const refractive::PinholeCamera<double> pinhole(result.camera.lens);
  double worst = 0;
  std::size_t compared = 0, pixels = 0, wrong_normals = 0;
  for (int y = 0; y < result.height(); y += kPixelStep)
    for (int x = 0; x < result.width(); x += kPixelStep) {
      ++compared;
      if (result.depth(y, x) == 0) continue;
      const auto ray = pinhole.ray({x, y});
      const Eigen::Vector3d X =
          result.pose.to_world(ray.at(static_cast<double>(result.depth(y, x))));
      worst = std::max(worst, scene.distance(X));
      const Eigen::Vector3f n(result.normal(y, x)[0], result.normal(y, x)[1],
                              result.normal(y, x)[2]);
      const auto hit =
          scene.hit(result.pose.centre, result.pose.rotation.transpose() * ray.direction);
      ASSERT_TRUE(hit);
      wrong_normals +=
          (result.pose.rotation.transpose() * n.cast<double>()).dot(hit->normal) < 0.95 ? 1 : 0;
      EXPECT_LE(n.cast<double>().dot(ray.direction), 0);
      EXPECT_GT(result.depth(y, x), result.min_depth);
      EXPECT_LT(result.depth(y, x), result.max_depth);
      ++pixels;
    }
  EXPECT_GT(pixels, compared * 7 / 10);
  // The errors are those of a chord over one pixel of the sphere (4 mm where it is seen
  // perpendicularly), and depth differences of up to 1 % that are not treated as steps.
  EXPECT_LT(worst, 0.01);
  EXPECT_LT(wrong_normals, pixels / 100);
}

TEST_P(Resampling, FillsHolesNearlyRight) {
  const AnalyticScene scene = plane();
  DepthMap map = exact_map(scene, model(), tilted_pose());
  const PinholeView view = pinhole_for(model(), kNear, kFar);
  const cv::Rect hole(60, 50, 80, 60);
  map.depth(hole) = 0.0f;
  const cv::Mat1f inverse = filled(render_surface(map, view), 1.0f);
  EXPECT_EQ(cv::countNonZero(inverse), static_cast<int>(inverse.total()));
  const Errors errors = lookup_errors(scene, model(), map, view, inverse);
  EXPECT_LT(errors.largest, 1.0);
}

TEST_P(Resampling, GivesTheSameForAnyNumberOfThreads) {
  const DepthMap map = exact_map(sphere_before_plane(), small(), tilted_pose());
  const PinholeView view = pinhole_for(small(), kNear, kFar);
  const cv::Mat1f surface = render_surface(map, view);
  cv::Mat3b photograph(small().height, small().width);
  cv::randu(photograph, 0, 255);
  std::vector<PinholeImage> images;
  for (const unsigned threads : {1u, 4u}) {
    const ThreadLimit limit(threads);
    images.push_back(resampled(photograph, {}, small(), view, surface, filled(surface, 1.0f)));
  }
  EXPECT_EQ(cv::norm(images[0].color, images[1].color, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(images[0].label, images[1].label, cv::NORM_INF), 0);
}

// A near square in front of a far plane. Both are perpendicular to the camera's axis.
DepthMap step_map(const CameraModel& model) {
  AnalyticScene far;
  far.plane = {Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(0, 0, 1.2)};
  AnalyticScene near = far;
  near.plane = {Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(0, 0, 0.7)};
  DepthMap map = exact_map(far, model, {});
  const cv::Rect middle(model.width / 3, model.height / 3, model.width / 3, model.height / 3);
  exact_map(near, model, {}).depth(middle).copyTo(map.depth(middle));
  return map;
}

TEST_P(Resampling, JoinsNoSteps) {
  const DepthMap map = step_map(small());
  const PinholeView view = pinhole_for(small(), kNear, kFar);
  const cv::Mat1f inverse = render_surface(map, view);
  std::size_t near = 0, far = 0;
  for (int y = 0; y < inverse.rows; ++y)
    for (int x = 0; x < inverse.cols; ++x) {
      if (inverse(y, x) == 0) continue;
      const double z = view.point({x, y}, 1 / static_cast<double>(inverse(y, x))).z();
      EXPECT_LT(std::min(std::abs(z - 0.7), std::abs(z - 1.2)), 1e-4) << x << ' ' << y;
      ++(z < 1 ? near : far);
    }
  EXPECT_GT(near, 1000u);
  EXPECT_GT(far, 6250u);
}

// Seen from the side, the near square hides the plane behind it, independently of the drawing
// order.
TEST(RenderSurface, TheNearestWins) {
  const CameraModel model = lens_in_air();
  const DepthMap map = step_map(model);
  for (const double aside : {-0.1, 0.1}) {
    const PinholeView view{model, {aside, 0, 0}, true};
    const cv::Mat1f inverse = render_surface(map, view);
    for (int u = 82; u < 158; ++u) {
      const Eigen::Vector3d X = refractive::PinholeCamera<double>(model.lens)
                                    .ray({u, 90})
                                    .at(static_cast<double>(map.depth(90, u)));
      const Eigen::Vector2d pixel = model.lens.pixel(X - view.centre);
      const int x = static_cast<int>(std::lround(pixel.x()));
      if (x < 0 || x >= inverse.cols) continue;
      EXPECT_NEAR(inverse(static_cast<int>(std::lround(pixel.y())), x), 1 / 0.7, 1e-3);
    }
  }
}

TEST(Filled, KeepsWhatIsThereAndIsSmooth) {
  cv::Mat1f ramp(37, 53);
  for (int y = 0; y < ramp.rows; ++y)
    for (int x = 0; x < ramp.cols; ++x) ramp(y, x) = 1 + 0.01f * static_cast<float>(x + 2 * y);
  cv::Mat1f holed = ramp.clone();
  holed(cv::Rect(20, 10, 8, 9)) = 0.0f;
  const cv::Mat1f result = filled(holed, 5);
  EXPECT_LT(cv::norm(result, ramp, cv::NORM_INF), 0.1);
  EXPECT_EQ(cv::norm(result(cv::Rect(0, 0, 20, 37)), ramp(cv::Rect(0, 0, 20, 37)), cv::NORM_INF),
            0);
  EXPECT_EQ(cv::norm(filled(cv::Mat1f(3, 4, 0.0f), 5), cv::Mat1f(3, 4, 5.0f), cv::NORM_INF), 0);
  cv::Mat1f one(1, 7, 0.0f);
  one(0, 3) = 2;
  EXPECT_EQ(cv::norm(filled(one, 5), cv::Mat1f(1, 7, 2.0f), cv::NORM_INF), 0);
}

TEST(PinholeImage, LeavesOutTransparentPixels) {
  const CameraModel model = flat(0.02, {0, 0, 1});
  const DepthMap map = exact_map(plane(), model, {});
  const PinholeView view = pinhole_for(model, kNear, kFar);
  const cv::Mat1f surface = render_surface(map, view);
  const cv::Mat3b photograph(model.height, model.width, cv::Vec3b(10, 20, 30));
  cv::Mat1b opaque(model.height, model.width, std::uint8_t{255});
  opaque(cv::Rect(0, 0, 120, 180)) = 0;
  const PinholeImage image =
      resampled(photograph, opaque, model, view, surface, filled(surface, 1.0f));
  const int middle = view.camera.height / 2;
  EXPECT_EQ(image.label(middle, view.camera.width / 2 - 5), kNothing);
  EXPECT_EQ(image.color(middle, view.camera.width / 2 - 5), cv::Vec3b(0, 0, 0));
  EXPECT_EQ(image.label(middle, view.camera.width / 2 + 5), kExact);
  EXPECT_EQ(image.color(middle, view.camera.width / 2 + 5), cv::Vec3b(10, 20, 30));
}

TEST(PinholeImage, MaskedPixelsKeepTheirColourAndAreNotUsable) {
  const CameraModel model = flat(0.02, {0, 0, 1});
  const PinholeView view = pinhole_for(model, kNear, kFar);
  const cv::Size size(view.camera.width, view.camera.height);
  const cv::Mat1f surface(size, 1.0f);
  const cv::Mat3b photograph(model.height, model.width, cv::Vec3b(10, 20, 30));
  cv::Mat1b mask(model.height, model.width, std::uint8_t{1});
  mask(cv::Rect(0, 0, model.width / 2, model.height)) = 0;
  const PinholeImage all = resampled(photograph, {}, model, view, surface, surface);
  const PinholeImage masked = resampled(photograph, {}, model, view, surface, surface, mask);
  const PinholeImage transparent = resampled(photograph, mask, model, view, surface, surface);
  EXPECT_EQ(cv::norm(all.color, masked.color, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(all.label, masked.label, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(all.usable, all.label != kNothing, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(masked.usable, transparent.usable, cv::NORM_INF), 0);
  const int usable = cv::countNonZero(masked.usable), without_mask = cv::countNonZero(all.usable);
  EXPECT_GT(usable, without_mask / 4);
  EXPECT_LT(usable, 3 * without_mask / 4);
}

TEST(PinholeImage, RefusesOtherSizes) {
  const CameraModel model = flat(0.02, {0, 0, 1});
  const PinholeView view = pinhole_for(model, kNear, kFar);
  const cv::Mat1f surface(view.camera.height, view.camera.width, 1.0f);
  const cv::Mat3b photograph(10, 10, cv::Vec3b(0, 0, 0));
  EXPECT_THAT(test::error_of([&] { resampled(photograph, {}, model, view, surface, surface); }),
              testing::HasSubstr("10x10"));
  DepthMap map = exact_map(plane(), model, {});
  map.camera = model.resized(120, 90);
  EXPECT_THAT(test::error_of([&] { render_surface(map, view); }), testing::HasSubstr("120x90"));
}

}  // namespace
}  // namespace axial::cloud
