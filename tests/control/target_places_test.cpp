// SPDX-License-Identifier: GPL-3.0-or-later
#include "control/target_places.h"

#include <cmath>
#include <vector>

#include "base/atomic_file.h"
#include "control/control_fixture.h"

namespace axial::control {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

using TargetPlacesFiles = ControlFiles;

TargetPlaces some_places() {
  TargetPlaces places{{{"target 7", {500000.125, -2.5, 3}, 11}, {"reef a", {1, 2, 1.0 / 3}, 2}},
                      Eigen::MatrixXd::Identity(6, 6) * 1e-8};
  places.covariance(0, 4) = places.covariance(4, 0) = -3e-9;
  return places;
}

TEST_F(TargetPlacesFiles, AreReadAsWritten) {
  TargetPlaces places = some_places();
  places.covariance(5, 5) = kNotKnown;
  places.crs = "EPSG:32617";
  write_target_places(folder_ / "places.json", places);
  const TargetPlaces read = read_target_places(folder_ / "places.json");
  ASSERT_EQ(read.targets.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(read.targets[i].label, places.targets[i].label);
    EXPECT_EQ(read.targets[i].world, places.targets[i].world);
    EXPECT_EQ(read.targets[i].photographs, places.targets[i].photographs);
  }
  EXPECT_EQ(read.covariance, places.covariance);
  EXPECT_EQ(read.crs, "EPSG:32617");
  write_target_places(folder_ / "none.json", {});
  EXPECT_TRUE(read_target_places(folder_ / "none.json").targets.empty());
}

TEST_F(TargetPlacesFiles, CommonTargetsAreThoseWithTheSameKeyAndAPlace) {
  TargetPlaces first = some_places(), second = some_places();
  second.targets = {{"Reef_A", {}, 1}, {"7", {}, 1}};
  EXPECT_THAT(common_targets(first, second), ElementsAre(Pair(0, 1), Pair(1, 0)));
  second.covariance(2, 2) = kNotKnown;
  EXPECT_THAT(common_targets(first, second), ElementsAre(Pair(0, 1)));
  first.covariance(0, 0) = kNotKnown;
  EXPECT_THAT(common_targets(first, second), ElementsAre());
}

TEST_F(TargetPlacesFiles, WrongFilesAreOneLineThatNamesThePlace) {
  const std::string row = "[1, 0, 0], [0, 1, 0], [0, 0, 1]";
  const auto with = [](const std::string& targets, const std::string& rows) {
    return R"({"targets": [)" + targets + R"(], "covariance_m2": [)" + rows + "]}";
  };
  const auto entry = [](const std::string& x) {
    return R"({"label": "a", "y": 0, "z": 0, "photographs": 1, "x": )" + x + "}";
  };
  struct Wrong {
    std::string text, expect;
  };
  const std::vector<Wrong> all{
      {"[]", ": is [], expected an object"},
      {R"({"targets": []})", ": covariance_m2 is missing"},
      {R"({"targets": {}, "covariance_m2": []})", ": targets is {}, expected a list"},
      {with("5", row), ": targets[0] is 5, expected an object"},
      {with(R"({"label": "a"})", row), ": targets[0].x is missing"},
      {with(R"({"label": 5})", row), ": targets[0].label is 5, expected a text"},
      {with(R"({"label": ""})", row), ": targets[0].label is \"\""},
      {with(entry("null"), row), ": targets[0].x is null, expected a number"},
      {with(entry("\"1\""), row), ": targets[0].x is \"1\""},
      {with(entry("1") + "," + entry("2"), row), ": targets[1].label is a, but a is in the list"},
      {with(R"({"label": "a", "x": 0, "y": 0, "z": 0, "photographs": -1})", row),
       ": targets[0].photographs is -1"},
      {with(entry("1"), "[1, 0, 0]"), ": covariance_m2 is [[1,0,0]], expected 3 rows"},
      {with(entry("1"), "[1, 0, 0], [0, 1], [0, 0, 1]"),
       ": covariance_m2[1] is [0,1], expected 3 numbers"},
      {with(entry("1"), "[1, 0, 0], [0, true, 0], [0, 0, 1]"), ": covariance_m2[1][1] is true"},
      {with(entry("1"), "[1, 0, 0], [0, -1, 0], [0, 0, 1]"), ": covariance_m2[1][1] is -1"},
      {with(entry("1"), "[1, 0, 0], [0, 1, 0], [0.5, 0, 1]"),
       ": covariance_m2[2][0] is not covariance_m2[0][2]"},
      {with(entry("1"), "[1, 0, 2], [0, 1, 0], [2, 0, 1]"),
       ": covariance_m2[2][0] is 2, more than its variances allow"},
  };
  for (const Wrong& wrong : all) {
    const auto file = put("places.json", wrong.text);
    const std::string message = test::error_naming(file, [&] { read_target_places(file); });
    EXPECT_THAT(message, testing::StartsWith(file.string() + wrong.expect)) << wrong.text;
    EXPECT_THAT(message, testing::Not(HasSubstr("\n"))) << wrong.text;
  }
}

TEST_F(TargetPlacesFiles, DamageIsSurvived) {
  write_target_places(folder_ / "valid.json", some_places());
  test::expect_damage_survived(folder_ / "places.json", read_file(folder_ / "valid.json"),
                               [](const auto& file) { return read_target_places(file); });
}

}  // namespace
}  // namespace axial::control
