// SPDX-License-Identifier: GPL-3.0-or-later
#include "control/labels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "support/error_of.h"

namespace axial::control {
namespace {

using testing::HasSubstr;

TEST(Labels, OfOneTargetAreWrittenInSeveralWays) {
  for (const char* label : {"target 7", "Target_7", " TARGET  07", "7", "007", "target7"})
    EXPECT_TRUE(same_label(label, "target 7")) << label;
  for (const char* label : {"target 70", "tag 7", "point 7", "target 7a", "0", "", "target"})
    EXPECT_FALSE(same_label(label, "target 7")) << label;
  EXPECT_TRUE(same_label("0", "target 0"));
  EXPECT_TRUE(same_label("tag 10", "tag 010"));
  EXPECT_FALSE(same_label("tag 10", "tag 1"));
}

Control two_bars() {
  Control control;
  control.points.push_back({.label = "target 7", .where = {}});
  control.points.push_back({.label = "corner-1", .where = {}});
  control.bars.push_back({"target 1", "target 2", 0.5, 0.001, false, {}});
  control.bars.push_back({"tag 3", "target 2", 0.5, 0.001, false, {}});
  return control;
}

TEST(Labels, NameChecks) {
  Control control = two_bars();
  mark_checks(control, std::vector<std::string>{"7", "target 2-target 1", "CORNER-1"});
  EXPECT_TRUE(control.points[0].check);
  EXPECT_TRUE(control.points[1].check);
  EXPECT_TRUE(control.bars[0].check);
  EXPECT_FALSE(control.bars[1].check);
  mark_checks(control, std::vector<std::string>{"tag 3-2"});
  EXPECT_TRUE(control.bars[1].check);
}

TEST(Labels, NameNoCheckThatIsNotThere) {
  Control control = two_bars();
  const std::vector<std::string> names{"target 7", "target 1-target 3"};
  EXPECT_THAT(test::error_of([&] { mark_checks(control, names); }), HasSubstr("target 1-target 3"));
  EXPECT_FALSE(control.points[0].check);
}

}  // namespace
}  // namespace axial::control
