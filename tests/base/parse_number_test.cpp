// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/parse_number.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace axial {
namespace {

TEST(ParseNumber, ReadsWholeTokensAndNothingElse) {
  EXPECT_EQ(parse_number<double>("-2.5e3"), -2500);
  EXPECT_EQ(parse_number<double>("+5"), 5);
  EXPECT_EQ(parse_number<std::uint8_t>("255"), 255);
  for (const char* token : {"", "+", "-", "+-5", "--5", "5 ", " 5", "5cm", "0x10", "1e999"})
    EXPECT_EQ(parse_number<double>(token), std::nullopt) << token;
  for (const char* token : {"256", "-1", "1.5"})
    EXPECT_EQ(parse_number<std::uint8_t>(token), std::nullopt) << token;
}

TEST(ParseNumber, LeavesInfinitiesToTheCallerAndParseFiniteDoesNot) {
  for (const char* token : {"inf", "-inf", "nan"}) {
    EXPECT_TRUE(parse_number<double>(token)) << token;
    EXPECT_EQ(parse_finite<double>(token), std::nullopt) << token;
  }
  EXPECT_EQ(parse_finite<double>("1e308"), 1e308);
  EXPECT_EQ(parse_finite<int>("-7"), -7);
}

}  // namespace
}  // namespace axial
