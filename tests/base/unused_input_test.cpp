// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/program/unused_input.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/program/program.h"
#include "support/captured_events.h"
#include "support/error_of.h"

namespace axial {
namespace {

using testing::HasSubstr;

TEST(UnusedInput, IsAnErrorThatNamesTheWayOut) {
  UnusedInput unused(false);
  const std::string said = test::error_of([&] { unused.report("--port X: is not there", {}); });
  EXPECT_THAT(said, testing::StartsWith("--port X: is not there"));
  EXPECT_THAT(said, HasSubstr("(allow_missing continues without it)"));
  EXPECT_TRUE(unused.lines().empty());
}

TEST(UnusedInput, IsAWarningWhereItIsAllowed) {
  test::CapturedEvents log;
  UnusedInput unused(true);
  unused.report("--port X: is not there", log.context);
  unused.report("--scale Y: no image", log.context);
  EXPECT_THAT(log.lines, HasSubstr("--port X: is not there; it is not used\n"));
  EXPECT_EQ(unused.lines(),
            (std::vector<std::string>{"--port X: is not there", "--scale Y: no image"}));
}

TEST(UnusedInput, IsAllowedByASwitch) {
  for (const auto& [words, expected] : std::vector<std::pair<std::vector<const char*>, bool>>{
           {{"Program"}, false},
           {{"Program", "--allow-missing"}, true},
           {{"Program", "--allow-missing", "1"}, true},
           {{"Program", "--allow-missing", "0"}, false}}) {
    bool allowed = false;
    ProgramOptions program{"Program", "tests", {}, {}};
    UnusedInput::declare(program.visible, allowed);
    parse_options(static_cast<int>(words.size()), words.data(), program);
    EXPECT_EQ(allowed, expected);
  }
}

}  // namespace
}  // namespace axial
