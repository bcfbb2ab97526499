// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/pixel_classes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "base/error.h"
#include "scene/camera_model.h"

namespace axial::evaluate {
namespace {

constexpr int kWidth = 160, kHeight = 120;

CameraModel pinhole() {
  return {kWidth, kHeight, {120, 120, 79.5, 59.5}, {}};
}

CameraModel behind_glass() {
  CameraModel model = pinhole();
  model.port = refractive::FlatPort<double>{{0, 0, 1}, 0.02, 0.014, 1, 1.52, 1.333};
  return model;
}

// The distance of the plane n.X = 1 along every ray.
cv::Mat1f distances_to(const Eigen::Vector3d& n, const CameraModel& camera) {
  cv::Mat1f distances(kHeight, kWidth);
  std::visit(
      [&](const auto& model) {
        for (int v = 0; v < kHeight; ++v)
          for (int u = 0; u < kWidth; ++u) {
            const auto ray = model.ray({u, v});
            distances(v, u) = static_cast<float>((1 - n.dot(ray.origin)) / n.dot(ray.direction));
          }
      },
      make_camera<double>(camera));
  return distances;
}

cv::Mat1b noise() {
  std::mt19937 random(3);
  cv::Mat1b grey(kHeight, kWidth);
  for (std::uint8_t& value : grey) value = static_cast<std::uint8_t>(random() % 256);
  return grey;
}

cv::Mat1f wall(double z) {
  return distances_to({0, 0, 1 / z}, pinhole());
}

TEST(PixelClasses, AreEdgesWhereAWindowSeesTwoSurfaces) {
  cv::Mat1f truth = wall(3);
  cv::Mat1f nearer = wall(2);
  constexpr int kFirst = 100;  // column of the farther wall
  nearer.colRange(0, kFirst).copyTo(truth.colRange(0, kFirst));
  const PixelClassMap classes = classes_of(truth, pinhole(), noise());
  for (int u = 1; u + 1 < kWidth; ++u) {
    const bool sees_both = u - 4 < kFirst && u + 4 >= kFirst;
    EXPECT_EQ(classes.at(u, 60) == PixelClass::edge, sees_both) << u;
  }
  EXPECT_EQ(classes.at(20, 60), PixelClass::open);
}

// Windows that contain a jump only in their outermost row.
TEST(PixelClasses, AreEdgesByTheCornersOfWindowsToo) {
  cv::Mat1f truth = wall(3);
  truth(cv::Rect(0, 0, 60, 40)) *= 0.5f;  // its last row is 39, its last column 59
  const PixelClassMap classes = classes_of(truth, pinhole(), noise());
  EXPECT_EQ(classes.at(60, 43), PixelClass::edge);
  EXPECT_EQ(classes.at(60, 44), PixelClass::open);
  EXPECT_EQ(classes.at(63, 40), PixelClass::edge);
  EXPECT_EQ(classes.at(64, 40), PixelClass::open);
}

TEST(PixelClasses, AreOpenUpToTheBorder) {
  const PixelClassMap classes = classes_of(wall(2), pinhole(), noise());
  for (const PixelClass pixel_class : classes.pixels) EXPECT_EQ(pixel_class, PixelClass::open);
}

TEST(PixelClasses, ArePlainWithoutTextureAndNothingWithoutTruth) {
  cv::Mat1f truth = wall(2);
  truth.rowRange(0, 30) = 0.0f;
  cv::Mat1b grey = noise();
  grey(cv::Rect(40, 60, 30, 30)) = std::uint8_t{128};
  const PixelClassMap classes = classes_of(truth, pinhole(), grey);
  EXPECT_EQ(classes.at(80, 10), PixelClass::nothing);
  EXPECT_EQ(classes.at(55, 75), PixelClass::plain);
  EXPECT_EQ(classes.at(100, 75), PixelClass::open);
}

// At the image centre the slant of a plane is the angle between its normal and the axis.
TEST(PixelClasses, AreSteepWhereTheSurfaceTurnsAway) {
  for (const CameraModel& camera : {pinhole(), behind_glass()})
    for (const double degrees : {0.0, 55.0, 65.0}) {
      const double angle = degrees * std::numbers::pi / 180;
      const Eigen::Vector3d n = Eigen::Vector3d(std::sin(angle), 0, std::cos(angle)) / 2;
      const auto classes = classes_of(distances_to(n, camera), camera, noise());
      EXPECT_EQ(classes.at(80, 60), degrees > 60 ? PixelClass::steep : PixelClass::open) << degrees;
    }
}

TEST(PixelClasses, NeedOneSize) {
  EXPECT_THROW(classes_of(wall(2), pinhole(), cv::Mat1b(60, 80)), Error);
  PixelClassOptions options;
  options.reach = 0;
  EXPECT_THROW(classes_of(wall(2), pinhole(), noise(), options), Error);
  EXPECT_THROW(classes_of(cv::Mat1f(60, 80, 1.0f), pinhole(), cv::Mat1b(60, 80)), Error);
}

ClassifiedMap classified(const DepthMap& map, const cv::Mat1f& truth, const cv::Mat1b& grey) {
  return {&map, evaluate_depth(map.depth, truth, {}), classes_of(truth, map.camera, grey)};
}

TEST(ErrorsByPlace, AreThoseOfItsPixels) {
  const cv::Mat1f truth = wall(2);
  cv::Mat1b grey = noise();
  const cv::Rect plain(40, 60, 40, 40);
  grey(plain) = std::uint8_t{128};
  DepthMap map;
  map.camera = pinhole();
  map.ids = {0};
  map.depth = truth.clone();
  map.depth += 0.001f;
  map.depth(plain) += 0.004f;
  map.depth(cv::Rect(50, 70, 3, 1)) += 0.5f;
  map.depth(cv::Rect(0, 0, kWidth, 10)) = 0.0f;
  const std::vector maps{classified(map, truth, grey), classified(map, truth, grey)};
  const auto classes = errors_by_class(maps);
  EXPECT_EQ(classes[0].truth_pixels, 0u);
  EXPECT_EQ(classes[0].mean, 0);
  EXPECT_EQ(classes[1].pixel_class, PixelClass::plain);
  // Counts the windows without noise: a band of 4 pixels on each side is lost.
  EXPECT_EQ(classes[1].truth_pixels, 2u * 32 * 32);
  EXPECT_EQ(classes[1].gross_pixels, 2u * 3);
  EXPECT_NEAR(classes[1].mean, 0.005, 1e-6);
  EXPECT_EQ(classes[3].gross_pixels, 0u);
  EXPECT_NEAR(classes[3].median, 0.001, 1e-6);
  EXPECT_LT(classes[3].compared_pixels, classes[3].truth_pixels);
}

TEST(ErrorsByPlace, AreGrossBeyondTheStepOfAnEdge) {
  for (const float sign : {-1.0f, 1.0f}) {
    EXPECT_FALSE(is_gross(sign * 0.039f, 2));
    EXPECT_TRUE(is_gross(sign * 0.041f, 2));
  }
}

// Depths with a wave over the fraction of a source pixel. Finite differences give the motion in the
// source image.
class Phases : public testing::TestWithParam<bool> {
 protected:
  static constexpr double kWave = 0.05;  // [px]

  void SetUp() override {
    for (const std::uint32_t id : {0u, 1u}) {
      DepthMap& map = maps_[id];
      map.camera = GetParam() ? behind_glass() : pinhole();
      map.ids = {id, 7, 1 - id};  // the first source has no map
      map.pose.centre = {id * 0.35, id * 0.05, 0};
      truth_[id] = distances_to({0.02, 0.03, 0.5}, map.camera);
      map.depth = truth_[id].clone();
    }
    truth_[1] = 0.0f;  // only the first map has a truth
  }

  // A position outside the image if the point is not visible.
  Eigen::Vector2d seen_by_source(int u, int v, double distance) const {
    return std::visit(
        [&](const auto& camera) -> Eigen::Vector2d {
          const auto image = camera.project(camera.ray({u, v}).at(distance) - maps_[1].pose.centre);
          return image.visible ? image.pixel : Eigen::Vector2d(-1, -1);
        },
        make_camera<double>(maps_[0].camera));
  }

  void add_wave() {
    for (int v = 0; v < kHeight; ++v)
      for (int u = 0; u < kWidth; ++u) {
        const double d = truth_[0](v, u), h = 1e-4;
        const double at = seen_by_source(u, v, d).x();
        const double motion = (seen_by_source(u, v, d + h).x() - at) / h;
        maps_[0].depth(v, u) +=
            static_cast<float>(kWave * std::sin(2 * std::numbers::pi * at) / motion);
      }
  }

  std::vector<PhaseErrors> phases() const {
    std::vector<ClassifiedMap> classified_maps{classified(maps_[0], truth_[0], noise())};
    classified_maps.push_back({&maps_[1], {}, {}});
    return errors_by_phase(classified_maps, 8);
  }

  std::array<DepthMap, 2> maps_;
  std::array<cv::Mat1f, 2> truth_;
};

// All depths are off by a thousandth. The shifts differ with the motion, but not over the fraction
// of a pixel.
TEST_P(Phases, ShowNoWaveWhereThereIsNone) {
  maps_[0].depth *= 1.001f;
  const auto bins = phases();
  for (const PhaseErrors& bin : bins) {
    EXPECT_GT(bin.count, 1000u);
    EXPECT_GT(std::abs(bin.shift), 0.01);
    EXPECT_NEAR(bin.shift, bins[0].shift, 0.1 * std::abs(bins[0].shift));
  }
}

TEST_P(Phases, AreThoseOfPixelsThatTheSourceImages) {
  std::size_t all = 0, inside = 0;
  for (const PhaseErrors& bin : phases()) all += bin.count;
  for (int v = 0; v < kHeight; ++v)
    for (int u = 0; u < kWidth; ++u) {
      const Eigen::Array2d at = seen_by_source(u, v, truth_[0](v, u)).array();
      inside += (at >= 0).all() && at.x() <= kWidth - 1 && at.y() <= kHeight - 1 ? 1 : 0;
    }
  EXPECT_EQ(all, inside);
  EXPECT_LT(inside, 0.9 * kWidth * kHeight);
}

TEST_P(Phases, ShowTheWaveThatIsThere) {
  add_wave();
  for (const PhaseErrors& bin : phases()) {
    const double middle = (bin.begin + bin.end) / 2;
    // The sine is monotonic in a bin and the phases are nearly uniform, so the median is near the
    // value at the middle.
    EXPECT_NEAR(bin.shift, kWave * std::sin(2 * std::numbers::pi * middle), 0.2 * kWave) << middle;
  }
}

INSTANTIATE_TEST_SUITE_P(BehindGlass, Phases, testing::Bool());

}  // namespace
}  // namespace axial::evaluate
