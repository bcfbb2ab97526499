// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/naming.h"

#include <gtest/gtest.h>

#include "support/error_of.h"

namespace axial {
namespace {

template <class Work>
std::string named(const Work& work) {
  return test::bracketed_error_of([&] { naming("a.ply", work); });
}

TEST(Naming, AddsTheFileToMessagesWithoutAFile) {
  EXPECT_EQ(named([] { fail("face 3 is wrong"); }), "a.ply: face 3 is wrong");
  EXPECT_EQ(named([] { fail("too large: give a smaller {}", setting("pixel")); }),
            "a.ply: too large: give a smaller <pixel>");
  EXPECT_EQ(naming("a.ply", [] { return 3; }), 3);
}

TEST(Naming, KeepsMessagesThatBeginWithAFileOrASetting) {
  EXPECT_EQ(named([] { fail_in("b.jpg", "is damaged"); }), "b.jpg: is damaged");
  EXPECT_EQ(named([] { naming("c.ply", [] { fail("is damaged"); }); }), "c.ply: is damaged");
  EXPECT_EQ(named([] { fail("{} 1,2: is wrong", setting("up")); }), "<up> 1,2: is wrong");
}

}  // namespace
}  // namespace axial
