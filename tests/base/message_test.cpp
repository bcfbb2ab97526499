// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/message.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "base/error.h"
#include "base/log.h"

namespace axial {
namespace {

using testing::HasSubstr;

TEST(Message, LeavesWhatFitsAsItIs) {
  for (const std::string text :
       {"", " ", "a.mvs: images[3].poseID is 17, but there are 4", "  two  blanks  "})
    EXPECT_EQ(as_message(text), text);
  EXPECT_EQ(as_message(std::string(kLongestWord, 'x')), std::string(kLongestWord, 'x'));
}

TEST(Message, ShowsBothEndsOfALongWord) {
  const std::string line =
      as_message("a.ply: property '" + std::string(5000, 'p') + "end' is not known");
  EXPECT_THAT(line, testing::StartsWith("a.ply: property 'ppp"));
  EXPECT_THAT(line, testing::EndsWith("pppend' is not known"));
  EXPECT_THAT(line, HasSubstr("p...p"));
  EXPECT_LE(line.size(), kLongestWord + 40);
}

// Text of arbitrary bytes, with words of any length.
rc::Gen<std::string> any_text() {
  return rc::gen::map(rc::gen::container<std::vector<std::pair<std::uint8_t, std::uint16_t>>>(
                          rc::gen::arbitrary<std::pair<std::uint8_t, std::uint16_t>>()),
                      [](const std::vector<std::pair<std::uint8_t, std::uint16_t>>& runs) {
                        std::string text;
                        for (const auto& [byte, length] : runs)
                          text.append(length % 700, static_cast<char>(byte));
                        return text;
                      });
}

RC_GTEST_PROP(Message, IsOneLineOfBoundedLength, ()) {
  const std::string text = *any_text();
  const std::string line = as_message(text);
  RC_ASSERT(line.size() <= kLongestMessage);
  RC_ASSERT(std::ranges::none_of(
      line, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }));
  RC_ASSERT(as_message(line) == line);
}

// The words on both sides of the gap stay separate words. Otherwise they could form a word that is
// too long.
TEST(Message, StaysAsItIsOnceItIsCut) {
  for (std::size_t length = 1; length <= 2 * kLongestWord; ++length) {
    std::string text;
    while (text.size() < 2 * kLongestMessage) text += std::string(length, 'w') + ' ';
    const std::string line = as_message(text);
    ASSERT_LE(line.size(), kLongestMessage);
    ASSERT_EQ(as_message(line), line) << length;
  }
}

RC_GTEST_PROP(Message, CutsIntoNoCharacter, (std::uint16_t length)) {
  for (const std::string character : {"\xC3\xA9", "\xE2\x82\xAC", "\xF0\x9F\x90\x9F"}) {
    std::string text = "x";
    for (int i = 0; i < length % 400; ++i) text += character;
    std::string line = as_message(text);
    line.erase(0, 1);
    if (const std::size_t gap = line.find("..."); gap != std::string::npos) line.erase(gap, 3);
    RC_ASSERT(line.size() % character.size() == 0u);
    for (std::size_t i = 0; i < line.size(); i += character.size())
      RC_ASSERT(line.substr(i, character.size()) == character);
  }
}

TEST(Message, IsWhatErrorsAndWarningsAre) {
  const std::string value = "two\nlines\t" + std::string(10000, 'v');
  try {
    fail("a.json: lens is '{}'", value);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.what(), as_message("a.json: lens is '" + value + "'"));
  }
  const LogCapture log;
  log_warning("a.json: lens is '{}'", value);
  EXPECT_EQ(log.text(), as_message("a.json: lens is '" + value + "'") + "\n");
}

}  // namespace
}  // namespace axial
