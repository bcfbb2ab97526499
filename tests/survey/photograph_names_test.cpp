// SPDX-License-Identifier: GPL-3.0-or-later
#include "survey/photograph_names.h"

#include <gtest/gtest.h>

namespace axial::survey {
namespace {

using Views = std::vector<std::size_t>;

Survey survey_of(const std::vector<const char*>& files) {
  Survey survey;
  for (const char* file : files) survey.views.emplace_back().file = file;
  return survey;
}

// Each name leads to its own photograph, also if another path ends with it.
TEST(PhotographNames, AreUnambiguous) {
  const Survey survey = survey_of({"/d/images/a.jpg", "/d/images/left/a.jpg",
                                   "/d/images/right/left/a.jpg", "/d/images/right/b.jpg"});
  const auto names = photograph_names(survey);
  ASSERT_EQ(names.size(), 4U);
  EXPECT_EQ(names[0], "a.jpg");
  EXPECT_EQ(names[2], "right/left/a.jpg");
  for (std::size_t view = 0; view < names.size(); ++view)
    EXPECT_EQ(views_named(names[view].generic_string(), survey), Views{view}) << names[view];
}

TEST(PhotographNames, OtherwiseAreEndsOfPaths) {
  const Survey survey = survey_of({"/d/left/a.jpg", "/d/right/a.jpg", "/d/right/b.jpg"});
  EXPECT_EQ(views_named("a.jpg", survey), (Views{0, 1}));
  EXPECT_EQ(views_named("b.jpg", survey), Views{2});
  EXPECT_EQ(views_named("d/left/a.jpg", survey), Views{0});
  EXPECT_EQ(views_named("/d/left/a.jpg", survey), Views{0});
  EXPECT_TRUE(views_named("ft/a.jpg", survey).empty());
  EXPECT_TRUE(views_named("a.jpg", {}).empty());
}

}  // namespace
}  // namespace axial::survey
