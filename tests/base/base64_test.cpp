// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/base64.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "support/error_of.h"

namespace axial {
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

RC_GTEST_PROP(Base64, DecodesWhatItEncoded, (const std::string& bytes)) {
  const std::string text = base64(bytes);
  RC_ASSERT(base64_decoded(text, "") == bytes);
  RC_ASSERT(base64_decoded(text.substr(0, text.find('=')), "") == bytes);  // without padding
}

TEST(Base64, DecodesTheCharactersForNamesOfFiles) {
  EXPECT_EQ(base64_decoded("-__-", "a"), base64_decoded("+//+", "a"));
}

TEST(Base64, NamesTheOwnerOfAnotherText) {
  EXPECT_EQ(test::error_of([] { base64_decoded("Zg=x", "a.gltf"); }),
            "a.gltf is not base64 at character 2");
  EXPECT_EQ(test::error_of([] { base64_decoded("Zm9vY", "a.gltf"); }),
            "a.gltf is base64 of a wrong length");
}

}  // namespace
}  // namespace axial
