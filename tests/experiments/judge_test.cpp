// SPDX-License-Identifier: GPL-3.0-or-later
// What the chain reads from a scene's files, and how it measures depth maps.
#include "experiments/judge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "base/atomic_file.h"
#include "base/error.h"
#include "io/cameras/housing.h"
#include "io/colmap/colmap.h"
#include "io/images/image.h"
#include "io/openmvs/dmap.h"
#include "support/empty_folder.h"
#include "support/error_of.h"

namespace axial::experiments {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::vector<std::string> words_of(const SceneOptions& options) {
  return to_json(options).get<std::vector<std::string>>();
}

// The word after `option`, and that `option` occurs once.
std::string value_of(const std::vector<std::string>& words, const std::string& option) {
  EXPECT_EQ(std::ranges::count(words, option), 1) << option;
  const auto found = std::ranges::find(words, option);
  return found == words.end() || found + 1 == words.end() ? "" : *(found + 1);
}

TEST(SceneWords, MoreOptionsReplaceThoseOfTheSameName) {
  SceneOptions options;
  options.width = 320;
  options.port = {"--tilt-degrees", "3"};
  options.more = {"--views", "4"};
  const std::vector<std::string> words = words_of(options);
  EXPECT_EQ(value_of(words, "--views"), "4");
  EXPECT_EQ(value_of(words, "--width"), "320");
  EXPECT_EQ(value_of(words, "--tilt-degrees"), "3");
  EXPECT_EQ(value_of(words, "--truth"), "1");
}

class Judged : public ::testing::Test {
 protected:
  SimulatedScene scene_{test::empty_folder()};

  void SetUp() override {
    make_folder(scene_.images("water"));
    make_folder(scene_.model());
  }
  void TearDown() override { fs::remove_all(scene_.folder); }

  void write_truth(const std::string& name, const cv::Mat1f& truth) {
    io::write_float_tiff(scene_.images("water") / (name + ".distance.tiff"), truth);
  }
};

TEST_F(Judged, SelfCalibrationStartsWithTheWatersMagnification) {
  io::ColmapModel model;
  model.cameras.push_back({1, "PINHOLE", 640, 480, {600, 602, 320.5, 240}});
  model.images.push_back({1, 1, "0000.jpg", {}, {}});
  io::write_colmap_text(scene_.model(), model);
  io::write_housing(scene_.housing(), io::housing_with(refractive::FlatPort<double>{
                                          {0, 0, 1}, 0.02, 0.01, 1, 1.5, 1.375}));
  EXPECT_EQ(port_of(scene_).n_water, 1.375);
  const Calibration in_air = true_lens(scene_), start = self_calibration(scene_);
  EXPECT_EQ(in_air.model, "PINHOLE");
  EXPECT_EQ(in_air.parameters, "600,602,320.5,240");
  EXPECT_FALSE(in_air.refine);
  EXPECT_EQ(start.model, "OPENCV");
  EXPECT_EQ(start.parameters, "825,827.75,320.5,240,0,0,0,0");
  EXPECT_TRUE(start.refine);
}

// The distances 1 to 100 m in two files; pixels without a truth do not count.
TEST_F(Judged, DistancesAreThoseOfAllImages) {
  for (const int file : {0, 1}) {
    cv::Mat1f truth(6, 10, 0.0f);
    for (int k = 0; k < 50; ++k) truth(k / 10, k % 10) = static_cast<float>(2 * k + 1 + file);
    write_truth(std::to_string(file), truth);
  }
  const SceneDistances distances = scene_distances(scene_, "water");
  EXPECT_DOUBLE_EQ(distances.median, 50.5);
  EXPECT_NEAR(distances.range_ratio, 95.05 / 5.95, 1e-9);
}

TEST_F(Judged, TimeThatCannotBeReadNamesItsFile) {
  write_atomically(scene_.folder / "densify.cpu-seconds", "12.50");
  EXPECT_EQ(densify_seconds(scene_.folder), 12.5);
  write_atomically(scene_.folder / "densify.cpu-seconds", "soon");
  EXPECT_THAT(test::error_of([&] { densify_seconds(scene_.folder); }),
              HasSubstr((scene_.folder / "densify.cpu-seconds").string()));
}

// A wall at z = 2 m, seen by a camera in air. A quarter of the columns has no estimate; the others
// are wrong by 3 mm, by 10 mm, and by a tenth of the distance. The first row has no truth.
class Wall : public Judged {
 protected:
  static constexpr int kWidth = 60, kHeight = 40, kQuarter = kWidth / 4;
  static constexpr double kFocal = 50, kTolerance = 0.005;

  void SetUp() override {
    Judged::SetUp();
    DepthMap map;
    map.image_path = (scene_.images("water") / "0000.jpg").string();
    map.ids = {0};
    map.camera = {kWidth, kHeight, {kFocal, kFocal, (kWidth - 1) / 2.0, (kHeight - 1) / 2.0}, {}};
    map.min_depth = 1;
    map.max_depth = 5;
    map.depth.create(kHeight, kWidth);
    map.normal = cv::Mat3f(kHeight, kWidth, cv::Vec3f(0, 0, -1));
    cv::Mat1f truth(kHeight, kWidth);
    for (int v = 0; v < kHeight; ++v)
      for (int u = 0; u < kWidth; ++u) {
        const double x = (u - map.camera.lens.cx) / kFocal, y = (v - map.camera.lens.cy) / kFocal;
        const double distance = 2 * std::sqrt(x * x + y * y + 1);
        const double estimates[] = {0, distance + 0.003, distance + 0.010, 1.1 * distance};
        map.depth(v, u) = static_cast<float>(estimates[u / kQuarter]);
        truth(v, u) = v == 0 ? 0.0f : static_cast<float>(distance);
      }
    write_truth("0000", truth);
    io::write_dmap(scene_.folder / "depth0000.dmap", map, "");
    write_photograph();
  }

  void write_photograph() {
    cv::Mat3b picture(kHeight, kWidth);
    std::mt19937 random(1);
    for (cv::Vec3b& pixel : picture) pixel = cv::Vec3b::all(static_cast<std::uint8_t>(random()));
    io::write_jpeg(scene_.images("water") / "0000.jpg", picture, 95);
  }

  Json errors() { return depth_errors(scene_.folder, scene_, "water", kTolerance); }
};

TEST_F(Wall, ErrorsAreThoseThatWereMade) {
  constexpr double kFloat = 1e-6;  // [m], several roundings of a distance of 2 m
  const Json all = errors();
  EXPECT_EQ(all.at("pixels"), 3 * kQuarter * (kHeight - 1));
  EXPECT_DOUBLE_EQ(all.at("completeness").get<double>(), 0.75);
  EXPECT_DOUBLE_EQ(all.at("gross").get<double>(), 1.0 / 3);
  EXPECT_DOUBLE_EQ(all.at("within").get<double>(), 1.0 / 3);
  EXPECT_NEAR(all.at("median").get<double>(), 0.010, kFloat);
  EXPECT_NEAR(all.at("mean").get<double>(), 0.0065, kFloat);
}

TEST_F(Wall, RingsAndPlacesHoldEveryPixelOnce) {
  const Json all = errors();
  std::size_t in_rings = 0, in_places = 0, gross = 0;
  for (const Json& ring : all.at("rings")) in_rings += ring.at("count").get<std::size_t>();
  for (const Json& place : all.at("places")) {
    in_places += place.at("pixels").get<std::size_t>();
    gross += place.at("gross").get<std::size_t>();
  }
  EXPECT_EQ(in_rings, all.at("pixels"));
  EXPECT_EQ(in_places, all.at("pixels"));
  EXPECT_EQ(gross, static_cast<std::size_t>(kQuarter * (kHeight - 1)));
  // This ring meets only the outer quarters: no estimates on the left, gross errors on the right.
  EXPECT_NEAR(all.at("rings").at(6).at("median").get<double>(), 0.1, 1e-6);
  EXPECT_EQ(all.at("places").back().at("place"), "all else");
}

TEST_F(Wall, AMissingPhotographIsNamed) {
  const fs::path photograph = scene_.images("water") / "0000.jpg";
  fs::remove(photograph);
  EXPECT_THAT(test::error_of([&] { errors(); }), HasSubstr(photograph.string()));
}

}  // namespace
}  // namespace axial::experiments
