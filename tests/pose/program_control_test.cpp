// SPDX-License-Identifier: GPL-3.0-or-later
// RefinePoses --targets, --bars, --control and --checks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "base/atomic_file.h"
#include "pose/refine_poses.h"
#include "targets/drawn_plate.h"

namespace axial::pose {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

// From the frame of the survey, in which the cameras look along z, to UTM coordinates, in which
// they look down.
Eigen::Vector3d in_world(const Eigen::Vector3d& place) {
  return {500000 + place.x(), 2500000 - place.y(), -20 - place.z()};
}

// Six plates on the ground at 0.8 m. Their places are those of points in the frame of the survey.
class ControlProgram : public RefinePoses {
 protected:
  std::vector<Eigen::Vector3d> places_{{-0.3, -0.2, 0.8}, {0.3, -0.2, 0.85}, {-0.3, 0.2, 0.85},
                                       {0.3, 0.2, 0.8},   {0, 0, 0.9},       {0.1, 0.15, 0.8}};

  static std::string label(std::size_t plate) { return fmt::format("target {}", plate + 1); }

  void SetUp() override {
    RefinePoses::SetUp();
    json targets = json::array();
    const PhotographCamera camera(truth_.cameras[0].now());
    for (const BundleImage& image : truth_.images)
      for (std::size_t plate = 0; plate < places_.size(); ++plate) {
        const PhotographImage seen = camera.image(image.pose.to_camera(places_[plate]));
        const Eigen::Vector2d pixel =
            testing::seen_by_lens((seen.pixel.x() - 511.5) / 610, (seen.pixel.y() - 383.5) / 615);
        if (seen.visible && pixel.minCoeff() > 0 && pixel.x() < 1023 && pixel.y() < 767)
          targets.push_back({{"label", label(plate)},
                             {"image", image.name},
                             {"x", pixel.x() + 0.5},
                             {"y", pixel.y() + 0.5},
                             {"sigma", 0.02}});
      }
    write_atomically(folder_ / "targets.json", json{{"targets", targets}}.dump());
  }

  double length(std::size_t a, std::size_t b) const { return (places_[a] - places_[b]).norm(); }

  // Two bars between plates, each `factor` times as long as in truth.
  void write_bars(double factor) const {
    write_atomically(folder_ / "bars.csv",
                     fmt::format("target 1,target 2,{},0.0001\ntarget 3,target 4,{},0.0001\n",
                                 factor * length(0, 1), factor * length(2, 3)));
  }

  // All plates as control points of 2 mm; `moved` is 50 mm off.
  void write_points(std::optional<std::size_t> moved = {}) const {
    json points = json::array();
    for (std::size_t plate = 0; plate < places_.size(); ++plate) {
      Eigen::Vector3d place = in_world(places_[plate]);
      if (plate == moved) place.x() += 0.05;
      points.push_back({{"label", label(plate)},
                        {"x", place.x()},
                        {"y", place.y()},
                        {"z", place.z()},
                        {"sigma", 0.002}});
    }
    write_atomically(folder_ / "control.json", json{{"points", points}}.dump());
  }

  json refined(const std::string& options, const std::string& out = "out") {
    said_ = succeed(kInput + "-o " + out + " --targets targets.json " + options);
    return json::parse(read_file(folder_ / out / "report.json"));
  }

  std::string said_;
};

TEST_F(ControlProgram, ABarGivesTheScaleAndAnotherChecksIt) {
  write_bars(1.01);
  const json report = refined("--bars bars.csv --checks \"target 3-target 4\"");
  ASSERT_THAT(report["control"]["bars"], SizeIs(2));
  const json &used = report["control"]["bars"][0], &check = report["control"]["bars"][1];
  EXPECT_EQ(used["use"], "used");
  EXPECT_EQ(check["use"], "check");
  // Both bars are 1 % too long, so that the model is larger and they agree.
  EXPECT_NEAR(check["length_m"]["residual"].get<double>(), 0, 1e-3);
  EXPECT_THAT(said_, HasSubstr("bar target 3-target 4: "));
  const io::ColmapModel model = io::read_colmap_model(folder_ / "out" / "sparse");
  EXPECT_NEAR(testing::pose_errors(found_poses(model), truth_).scale, 1 / 1.01, 1e-3);
  EXPECT_LE(model.points.size(), truth_.points.size());  // targets are no points of COLMAP's
}

// On the central meridian of a UTM zone, one metre on the ground is 0.9996 m on the map.
TEST_F(ControlProgram, LengthsOfBarsAreOnTheGround) {
  write_points();
  write_bars(1 / 0.9996);
  json points = json::parse(read_file(folder_ / "control.json"));
  points["crs"] = "EPSG:32617";
  write_atomically(folder_ / "control.json", points.dump());
  const json report =
      refined("--control control.json --bars bars.csv --checks \"target 3-target 4\"");
  EXPECT_THAT(said_, HasSubstr("One metre is 0.99960 m on the map of the control points"));
  EXPECT_NEAR(report["control"]["map_scale"].get<double>(), 0.9996, 1e-6);
  for (const json& bar : report["control"]["bars"])
    EXPECT_NEAR(bar["length_m"]["residual"].get<double>(), 0, 2e-5);  // 0.0002 m without the map
  // One place does not scale the model, so that lengths stay as they are.
  points["points"] = json::array({points["points"][0]});
  write_atomically(folder_ / "control.json", points.dump());
  EXPECT_EQ(refined("--control control.json --bars bars.csv", "one")["control"]["map_scale"], 1);
}

TEST_F(ControlProgram, ControlPointsPlaceTheModel) {
  write_points();
  const json report = refined("--control control.json");
  EXPECT_THAT(report["control"]["left_out"], IsEmpty());
  for (const json& point : report["control"]["points"])
    for (const char* axis : {"x_m", "y_m", "z_m"})
      EXPECT_NEAR(point[axis]["residual"].get<double>(), 0, 1e-3);
  const Bundle found = found_poses(io::read_colmap_model(folder_ / "out" / "sparse"));
  for (std::size_t i = 0; i < found.images.size(); ++i)
    EXPECT_LT((found.images[i].pose.centre - in_world(truth_.images[i].pose.centre)).norm(), 3e-3);
  const json places = json::parse(read_file(folder_ / "out" / "target_places.json"));
  ASSERT_THAT(places["targets"], SizeIs(places_.size()));
  EXPECT_THAT(places["covariance_m2"], SizeIs(3 * places_.size()));
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const json& one = places["targets"][i];
    EXPECT_EQ(one["label"], label(i));
    EXPECT_NEAR(one["x"].get<double>(), in_world(places_[i]).x(), 1e-3);
  }
}

// The result of the first run is in UTM coordinates, and the second run keeps its poses. 5 mm: the
// points of 2 mm, seen by poses that the first run found with these points.
TEST_F(ControlProgram, KnownPosesKeepTheirFrame) {
  write_points();
  refined("--control control.json");
  const std::string known =
      "-i out/sparse --lens lens/cameras.txt --housing out/housing.json --poses known -o known ";
  succeed(known + "--targets targets.json --control control.json");
  const json report = json::parse(read_file(folder_ / "known" / "report.json"));
  ASSERT_THAT(report["control"]["points"], SizeIs(places_.size()));
  for (const json& point : report["control"]["points"])
    EXPECT_NEAR(point["x_m"]["residual"].get<double>(), 0, 5e-3);
  const auto centres = [&](const char* folder) {
    return found_poses(io::read_colmap_model(folder_ / folder / "sparse")).images;
  };
  for (std::size_t i = 0; i < truth_.images.size(); ++i)
    EXPECT_LT((centres("out")[i].pose.centre - centres("known")[i].pose.centre).norm(), 1e-6);
}

TEST_F(ControlProgram, PlacesOfAnotherRunGo) {
  write_bars(1);
  refined("--bars bars.csv");
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / "target_places.json"));
  succeed(kInput + "-o out --scale-from " + baseline());
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out" / "target_places.json"));
}

TEST_F(ControlProgram, APlateThatMovedIsNamed) {
  write_points(1);
  const json report = refined("--control control.json");
  ASSERT_THAT(report["control"]["left_out"], SizeIs(1));
  EXPECT_THAT(report["control"]["left_out"][0], HasSubstr("target 2 is"));
  EXPECT_THAT(said_, HasSubstr(report["control"]["left_out"][0].get<std::string>()));
}

TEST_F(ControlProgram, TheSameBytesForAnyNumberOfThreads) {
  write_bars(1);
  write_points();
  refined("--bars bars.csv --control control.json --max-threads 1", "one");
  refined("--bars bars.csv --control control.json --max-threads 2", "two");
  for (const char* file : {"report.json", "target_places.json", "sparse/images.txt"})
    EXPECT_TRUE(read_file(folder_ / "one" / file) == read_file(folder_ / "two" / file)) << file;
}

// Each photograph shows the plates where targets.json has their centres.
TEST_F(ControlProgram, FindsTargetsItself) {
  constexpr int kSide = 48;  // of the picture of a plate [px]
  std::map<std::string, cv::Mat1b> photographs;
  for (const BundleImage& image : truth_.images)
    photographs[image.name] = cv::Mat1b(768, 1024, uchar{90});
  const json known = json::parse(read_file(folder_ / "targets.json"));
  std::size_t whole = 0;
  for (const json& target : known["targets"]) {
    const Eigen::Vector2d centre(target["x"], target["y"]);
    const cv::Rect place(static_cast<int>(centre.x()) - kSide / 2,
                         static_cast<int>(centre.y()) - kSide / 2, kSide, kSide);
    if ((place & cv::Rect(0, 0, 1024, 768)) != place) continue;
    test::PlateView view{.size = {kSide, kSide}, .width = 36, .noise = 0};
    view.centre = centre - Eigen::Vector2d(place.x, place.y);
    const std::string number = target["label"].get<std::string>().substr(7);
    test::photograph(view,
                     targets::Pattern(targets::parse_family("circular12"), std::stoul(number)))
        .copyTo(photographs[target["image"]](place));
    ++whole;
  }
  std::filesystem::create_directory(folder_ / "photographs");
  for (const auto& [name, picture] : photographs)
    cv::imwrite((folder_ / "photographs" / name).string(), picture,
                {cv::IMWRITE_JPEG_QUALITY, 100});
  write_bars(1);
  const std::string options = "--targets find --bars bars.csv --checks \"target 3-target 4\" ";
  succeed(kInput + "-o out --images photographs --families circular12 " + options);
  const json found = json::parse(read_file(folder_ / "out" / "targets.json"));
  EXPECT_EQ(found["targets"].size(), whole);
  const json report = json::parse(read_file(folder_ / "out" / "report.json"));
  EXPECT_EQ(report["control"]["targets"], places_.size());
  EXPECT_NEAR(report["control"]["bars"][1]["length_m"]["residual"].get<double>(), 0, 1e-3);

  const std::string refused = kInput + "-o none -v 0 " + options;
  expect_refusal("RefinePoses", refused, "--targets find: needs --images");
  std::filesystem::remove(folder_ / "photographs" / truth_.images[3].name);
  expect_refusal("RefinePoses", refused + "--images photographs",
                 "has no photograph " + truth_.images[3].name);
  cv::imwrite((folder_ / "photographs" / truth_.images[3].name).string(),
              cv::Mat1b(768, 1024, uchar{90}));
  expect_refusal("RefinePoses", refused + "--images photographs --families APRILTAG_36h11",
                 "no photograph of");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "none"));
}

TEST_F(ControlProgram, WhatCannotBeUsedIsAWarning) {
  write_atomically(folder_ / "bars.csv", "target 1,target 99,0.2\n");
  refined("--bars bars.csv");
  EXPECT_THAT(said_, HasSubstr("bars.csv:1: bar target 1-target 99: no photograph with a pose"));
}

TEST_F(ControlProgram, RefusesWrongInput) {
  write_bars(1);
  const std::string command = kInput + "-o out -v 0 --targets targets.json ";
  expect_refusal("RefinePoses", command + "--bars none.csv", "none.csv: cannot be opened");
  expect_refusal("RefinePoses", command + "--bars bars.csv --checks 'target 77'",
                 "check 'target 77': there is no control point and no bar");
  expect_refusal("RefinePoses", kInput + "-o out -v 0 --bars bars.csv", "--targets is missing");
  for (const char* text : {"target 1,target 2,zero\n", "target 1,target 2,-1\n"}) {
    write_atomically(folder_ / "bars.csv", text);
    expect_refusal("RefinePoses", command + "--bars bars.csv", "bars.csv:1");
  }
}

}  // namespace
}  // namespace axial::pose
