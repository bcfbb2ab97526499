// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/base64.h"

#include <gtest/gtest.h>

namespace axial::view {
namespace {

TEST(Base64, EncodesTheTextsOfTheStandard) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

TEST(Base64, EncodesAllBytes) {
  EXPECT_EQ(base64(std::string("\x00\x10\x83\xff\xfe\xfb", 6)), "ABCD//77");
}

}  // namespace
}  // namespace axial::view
