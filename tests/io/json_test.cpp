// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/bytes/json.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace axial::io {
namespace {

using Ordered = nlohmann::ordered_json;

TEST(JsonText, ReadsBackWhatItWrote) {
  const Ordered json{{"z", {1, 2.5, nullptr}}, {"a", "\"\\ \n \u00b0"}, {"m", Ordered::object()}};
  for (const int indent : {-1, 0, 2}) EXPECT_EQ(json_from(to_text(json, indent)), json) << indent;
  EXPECT_EQ(to_text(json).find('\n'), std::string::npos);
  EXPECT_EQ(to_text(Ordered{{"z", 1}, {"a", 2}}), R"({"z":1,"a":2})");
}

TEST(JsonText, ReplacesBytesThatAreNotUtf8) {
  EXPECT_EQ(to_text(Ordered("a\xff!")), "\"a\xef\xbf\xbd!\"");
}

TEST(JsonText, IsNullWhereItIsMalformed) {
  for (const char* text : {"", "{", "{\"a\": }", "[1] 2", "nul", "\"\xff\""})
    EXPECT_TRUE(json_from(text).is_null()) << text;
}

}  // namespace
}  // namespace axial::io
