// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/need_cases.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <stdexcept>

namespace axial::experiments {
namespace {

NeedCase case_named(const std::string& name) {
  for (const NeedCase& one : need_cases(false))
    if (one.name == name) return one;
  throw std::invalid_argument(name);
}

// A name names a file and a row of the table.
TEST(NeedCases, DifferInNameAndWhatIsDone) {
  const std::vector<NeedCase> all = need_cases(false);
  std::set<std::string> names, done;
  for (const NeedCase& one : all) {
    names.insert(one.name);
    const Json calibrated = one.calibrated_in ? to_json(*one.calibrated_in) : Json();
    done.insert(to_json(one.scene).dump() + calibrated.dump());
  }
  EXPECT_EQ(names.size(), all.size());
  EXPECT_EQ(done.size(), all.size());
  EXPECT_EQ(all.front().name, "usual");
  EXPECT_FALSE(all.front().calibrated_in);
}

// Other ground at another distance, with the lens that was calibrated in the usual scene.
TEST(NeedCases, ASecondSurveyUsesTheLensOfTheUsualScene) {
  const NeedCase usual = case_named("usual"), second = case_named("second_survey_0.5");
  ASSERT_TRUE(second.calibrated_in);
  EXPECT_EQ(to_json(*second.calibrated_in), to_json(usual.scene));
  EXPECT_NE(second.scene.seed, usual.scene.seed);
  EXPECT_EQ(second.scene.scale, 0.5 * usual.scene.scale);
}

TEST(NeedCases, AQuickRunHasSmallScenesOfTheSameNames) {
  std::vector<std::string> names;
  for (const NeedCase& one : need_cases(true)) {
    names.push_back(one.name);
    const SceneOptions whole = case_named(one.name).scene;
    EXPECT_LT(one.scene.width, whole.width) << one.name;
    EXPECT_LT(one.scene.views, whole.views) << one.name;
    EXPECT_EQ(one.scene.port, whole.port) << one.name;
    if (one.calibrated_in) {
      EXPECT_EQ(one.calibrated_in->width, one.scene.width) << one.name;
    }
  }
  EXPECT_THAT(names, ::testing::ElementsAre("usual", "tilt_degrees_6", "second_survey_0.5"));
}

}  // namespace
}  // namespace axial::experiments
