// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/file_extension.h"

#include <gtest/gtest.h>

namespace axial {
namespace {

TEST(LowerExtension, IsTheLastOneWithItsDot) {
  EXPECT_EQ(lower_extension("dive/A.PNG"), ".png");
  EXPECT_EQ(lower_extension("scan.tar.GZ"), ".gz");
  EXPECT_EQ(lower_extension("dive.1/photo"), "");
  EXPECT_EQ(lower_extension(".hidden"), "");
}

}  // namespace
}  // namespace axial
