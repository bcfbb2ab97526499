// SPDX-License-Identifier: GPL-3.0-or-later
// --targets, --bars and --control of RefinePoses: from files to a bundle, and to reports.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../../apps/RefinePoses/control.h"
#include "../../apps/RefinePoses/control_report.h"
#include "base/atomic_file.h"
#include "io/bytes/json.h"
#include "pose/adjust/adjust.h"
#include "pose/survey.h"
#include "support/empty_folder.h"
#include "support/error_of.h"

namespace axial::pose {
namespace {

namespace fs = std::filesystem;
using apps::AddedControl;
using apps::ControlOptions;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class ControlInput : public ::testing::Test {
 protected:
  Bundle bundle_ = testing::survey(testing::camera_behind(testing::flat_port()), {.points = 80});
  Bundle truth_ = bundle_;
  RefineOptions refine_;
  control::Control files_;

  // The exact image of a point in an image, in the pixels of files.
  void see(const std::string& label, std::size_t image, const Eigen::Vector3d& point) {
    const PhotographCamera camera(truth_.cameras[0].now());
    control::TargetImage seen;
    seen.label = label;
    seen.image = truth_.images[image].name;
    seen.pixel = camera.image(truth_.images[image].pose.to_camera(point)).pixel.array() + 0.5;
    seen.sigma = 0.02;
    seen.where = "targets.json";
    files_.images.push_back(seen);
  }

  AddedControl add() { return apps::add_control(files_, bundle_, refine_); }
};

const Eigen::Vector3d kFirst(-0.1, 0, 0.8), kSecond(0.1, 0.05, 0.8);

TEST_F(ControlInput, AddsPointsAtTheRightPixels) {
  for (std::size_t image = 4; image < 8; ++image) see("target 1", image, kFirst);
  EXPECT_THAT(add().unused, IsEmpty());
  ASSERT_TRUE(bundle_.points.back().is_target);
  // Half a pixel would move the point by 0.6 mm.
  EXPECT_LT((bundle_.points.back().position - kFirst).norm(), 1e-6);
  EXPECT_GT(bundle_.points.back().source, truth_.points.back().source);
}

TEST_F(ControlInput, FindsBarsAndPointsByTheirLabels) {
  for (std::size_t image = 4; image < 8; ++image) {
    see("target 1", image, kFirst);
    see("Target_02", image, kSecond);
  }
  files_.bars.push_back({"target 2", "1", 0.2, 0.001, false, "bars.csv:1"});
  files_.bars.push_back({"target 1", "target 2", 0.2, 0.001, true, "bars.csv:2"});
  files_.points.push_back({"1", {1, 2, 3}, {0.1, 0.1, 0.1}, false, "c.csv:1"});
  files_.points.push_back({truth_.images[2].name,
                           {0, 0, -3},
                           {control::kNotKnown, control::kNotKnown, 0.1},
                           false,
                           "c.csv:2"});
  const AddedControl added = add();
  EXPECT_THAT(added.unused, IsEmpty());
  ASSERT_THAT(refine_.adjust.distances, SizeIs(1));
  EXPECT_NE(refine_.adjust.distances[0].first, refine_.adjust.distances[0].second);
  EXPECT_THAT(added.checks.distances, SizeIs(1));
  ASSERT_THAT(refine_.adjust.places, SizeIs(2));
  EXPECT_EQ(refine_.adjust.places[1].of, KnownDistance::Between::images);
  EXPECT_EQ(refine_.adjust.places[1].index, 2);
  EXPECT_FALSE(refine_.adjust.places[1].knows(0));
}

TEST_F(ControlInput, NamesWhatCannotBeUsed) {
  for (std::size_t image = 4; image < 8; ++image) see("target 1", image, kFirst);
  see("target 2", 4, kSecond);
  see("target 3", 4, kSecond);
  see("target 3", 4, kFirst);
  files_.images.push_back(files_.images.back());
  files_.images.back().image = "strange.jpg";
  files_.bars.push_back({"target 1", "target 2", 0.2, 0.001, false, "bars.csv:1"});
  files_.bars.push_back({"target 1", "target 9", 0.2, 0.001, false, "bars.csv:2"});
  files_.points.push_back({"target 8", {1, 2, 3}, {0.1, 0.1, 0.1}, false, "c.csv:1"});
  EXPECT_THAT(
      add().unused,
      ElementsAre(
          HasSubstr("shows target 3 more than once"),
          HasSubstr("1 photographs with targets have no pose, first strange.jpg"),
          HasSubstr("bars.csv:1: bar target 1-target 2: 1 photograph with a pose shows target 2"),
          HasSubstr("bars.csv:2: bar target 1-target 9: no photograph with a pose"),
          HasSubstr("c.csv:1: no photograph with a pose shows target 8")));
  EXPECT_THAT(refine_.adjust.distances, IsEmpty());
}

TEST_F(ControlInput, ANumberIsNoNameOfAPhotograph) {
  for (std::size_t image = 4; image < 8; ++image) see("target 1", image, kFirst);
  bundle_.images[2].name = "17.jpg";
  files_.points.push_back({"17", {1, 2, 3}, {0.1, 0.1, 0.1}, false, "c.csv:1"});
  EXPECT_THAT(add().unused, ElementsAre(HasSubstr("no photograph with a pose shows 17")));
  EXPECT_THAT(refine_.adjust.places, IsEmpty());
}

TEST_F(ControlInput, ReportsPointsInTheWorld) {
  for (std::size_t image = 2; image < 8; ++image) see("target 1", image, kFirst);
  files_.points.push_back({"target 1", kFirst, {0.01, 0.01, 0.01}, false, "c.csv:1"});
  add();
  correct_targets(bundle_, refine_.targets);
  adjust(bundle_, refine_.adjust);
  const LocalFrame frame{{500000, 2500000, -20}};
  const auto json = control_json(apps::control_results(bundle_, refine_.adjust, frame, {}, {}));
  const auto& x = json["points"][0]["x_m"];
  EXPECT_NEAR(x["stated"].get<double>(), 500000 + kFirst.x(), 1e-9);
  EXPECT_NEAR(x["found"].get<double>(), 500000 + kFirst.x(), 0.01);
}

// A bar gives no position: nothing tells where the model is.
TEST_F(ControlInput, ChecksThatNothingDeterminesAreNotCompared) {
  for (std::size_t image = 2; image < 8; ++image) {
    see("target 1", image, kFirst);
    see("target 2", image, kSecond);
  }
  files_.bars.push_back(
      {"target 1", "target 2", (kFirst - kSecond).norm(), 0.001, false, "bars.csv:1"});
  files_.points.push_back(
      {"target 2", kSecond + Eigen::Vector3d(5, 0, 0), {0.01, 0.01, 0.01}, true, "c.csv:1"});
  AddedControl added = add();
  correct_targets(bundle_, refine_.targets);
  adjust(bundle_, refine_.adjust);
  const apps::ControlResults results =
      apps::control_results(bundle_, refine_.adjust, {}, added.checks, {});
  EXPECT_THAT(apps::control_warnings(results), IsEmpty());
  EXPECT_TRUE(control_json(results)["points"][0]["x_m"]["residual"].is_null());
  EXPECT_THAT(apps::control_lines(results).back(), HasSubstr("not determined"));
}

TEST_F(ControlInput, ReportsBarsAndPlaces) {
  for (std::size_t image = 2; image < 8; ++image) {
    see("target 1", image, kFirst);
    see("target 2", image, kSecond);
  }
  const double length = (kFirst - kSecond).norm();
  files_.bars.push_back({"target 1", "target 2", length + 0.01, 0.001, false, "bars.csv:1"});
  files_.bars.push_back({"target 1", "target 2", length, 0.001, true, "bars.csv:2"});
  AddedControl added = add();
  correct_targets(bundle_, refine_.targets);
  adjust(bundle_, refine_.adjust);
  const apps::ControlResults results =
      apps::control_results(bundle_, refine_.adjust, {}, added.checks, {"a line"});
  EXPECT_EQ(results.targets, 2);
  EXPECT_EQ(results.observations, 12);
  const auto json = control_json(results);
  ASSERT_THAT(json["bars"], SizeIs(2));
  EXPECT_EQ(json["bars"][0]["use"], "used");
  EXPECT_EQ(json["bars"][1]["use"], "check");
  EXPECT_EQ(json["bars"][0]["photographs"], 6);
  // The used bar stretched the model by its error, which the check shows.
  EXPECT_LT(std::abs(json["bars"][0]["length_m"]["residual"].get<double>()), 0.001);
  EXPECT_NEAR(json["bars"][1]["length_m"]["residual"].get<double>(), 0.01, 0.001);
  EXPECT_THAT(apps::control_warnings(results),
              ElementsAre("a line", HasSubstr("The check bar target 1-target 2 is off by")));
  const fs::path folder = test::empty_folder();
  control::write_target_places(
      folder / "places.json",
      apps::target_places(bundle_, refine_.adjust, refine_.targets, {{1000, 2000, 0}}));
  const auto places = nlohmann::json::parse(read_file(folder / "places.json"));
  ASSERT_THAT(places["targets"], SizeIs(2));
  EXPECT_NEAR(places["targets"][0]["x"].get<double>(),
              1000 + bundle_.points[bundle_.points.size() - 2].position.x(), 1e-9);
  ASSERT_THAT(places["covariance_m2"], SizeIs(6));
  EXPECT_GT(places["covariance_m2"][0][0].get<double>(), 0);
  fs::remove_all(folder);
}

TEST(ControlOptionsTest, NeedTargets) {
  ControlOptions options;
  options.bars = "bars.csv";
  EXPECT_THAT(test::error_of([&] { apps::check(options); }),
              HasSubstr("--bars bars.csv: is for targets"));
  options = {};
  options.epsg = 32617;
  EXPECT_THAT(test::error_of([&] { apps::check(options); }), HasSubstr("--epsg 32617: is for"));
}

}  // namespace
}  // namespace axial::pose
