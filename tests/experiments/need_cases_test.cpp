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

// A name names a file, and a title a row of the table.
TEST(NeedCases, DifferInNameTitleAndWhatIsDone) {
  const std::vector<NeedCase> all = need_cases(false);
  std::set<std::string> names, titles, done;
  for (const NeedCase& one : all) {
    names.insert(one.name);
    titles.insert(title_of(one));
    const Json calibrated = one.calibrated_in ? to_json(*one.calibrated_in) : Json();
    done.insert(to_json(one.scene).dump() + calibrated.dump());
  }
  EXPECT_EQ(names.size(), all.size());
  EXPECT_EQ(titles.size(), all.size());
  EXPECT_EQ(done.size(), all.size());
  EXPECT_TRUE(all.front().is_usual());
  EXPECT_FALSE(all.front().calibrated_in);
}

TEST(NeedCases, TitlesSayWhatIsVaried) {
  EXPECT_EQ(title_of(case_named("usual")), "the usual case");
  EXPECT_EQ(title_of(case_named("tilt_degrees_6")), "tilt 6\u00b0");
  EXPECT_EQ(title_of(case_named("scale_2")), "everything but the port, times 4");
  EXPECT_EQ(title_of(case_named("near_tilt_degrees_6")),
            "everything but the port, times 0.5, and tilt 6\u00b0");
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
