// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/split.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace axial {
namespace {

using testing::ElementsAre;

TEST(Split, FindsAllWords) {
  EXPECT_THAT(split("", ','), ElementsAre());
  EXPECT_THAT(split("one", ','), ElementsAre("one"));
  EXPECT_THAT(split("1,23, 4", ','), ElementsAre("1", "23", " 4"));
  EXPECT_THAT(split("1 2,3", ' '), ElementsAre("1", "2,3"));
}

TEST(Split, KeepsEmptyWords) {
  EXPECT_THAT(split(",", ','), ElementsAre("", ""));
  EXPECT_THAT(split(",a,,b,", ','), ElementsAre("", "a", "", "b", ""));
}

}  // namespace
}  // namespace axial
