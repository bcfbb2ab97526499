// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/naming.h"

#include <gtest/gtest.h>

#include "support/error_of.h"

namespace axial {
namespace {

std::string named(const std::string& message) {
  return test::error_of([&] { naming("a.ply", [&] { fail("{}", message); }); });
}

TEST(Naming, AddsTheFileToMessagesWithoutAFile) {
  EXPECT_EQ(named("face 3 is wrong"), "a.ply: face 3 is wrong");
  EXPECT_EQ(named("--up: is wrong"), "--up: is wrong");
  EXPECT_EQ(named("/b.jpg: is damaged"), "/b.jpg: is damaged");
}

TEST(Naming, KeepsMessagesThatNameTheirFile) {
  const auto load = [] { fail("b.jpg: is damaged"); };
  EXPECT_EQ(test::error_of([&] { naming("a.ply", [&] { already_named(load); }); }),
            "b.jpg: is damaged");
  EXPECT_EQ(already_named([] { return 3; }), 3);
}

}  // namespace
}  // namespace axial
