// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/target_table.h"

#include <gmock/gmock.h>

#include <vector>

#include "io/wrong_input.h"
#include "targets/codes/ring_codes.h"

namespace axial::targets {
namespace {

class TargetTable : public test::FolderTest {
 protected:
  Family read(const std::string& text, const std::string& family = "circular12") const {
    test::put(folder_ / "table.csv", text);
    Family result = parse_family(family);
    read_target_table(folder_ / "table.csv", result);
    return result;
  }
};

TEST_F(TargetTable, NamesTheCodesOfRings) {
  const auto codes = ring_codes(12);
  const std::uint32_t turned = ((codes[4] << 3) | (codes[4] >> 9)) & 0xfff;
  const Family family =
      read(fmt::format("# of our plates\n{},target 1\r\n{}, \"north, east\"\n", codes[6], turned));
  EXPECT_EQ(label_of(family, 7), "target 1");
  EXPECT_EQ(label_of(family, 5), "north, east");
  EXPECT_EQ(label_of(family, 1), fmt::format("code {}", codes[0]));
}

TEST_F(TargetTable, NamesTheNumbersOfMarkers) {
  const Family family = read("3,corner", "4X4_50");
  EXPECT_EQ(label_of(family, 3), "corner");
  EXPECT_EQ(label_of(family, 4), "code 4");
}

TEST_F(TargetTable, WrongLinesAreNamed) {
  for (const auto& [text, expected] : std::vector<std::pair<std::string, std::string>>{
           {"", "has no line"},
           {"1", ":1: must be CODE,LABEL"},
           {"1,", ":1: must be CODE,LABEL"},
           {"3,a\n1,\"b", ":2: must be CODE,LABEL"},
           {"a,b", ":1: 'a' is no code of 4X4_50"},
           {"50,b", ":1: '50' is no code of 4X4_50"},
           {"3,a\n4,a", ":2: the label 'a' occurs twice"},
           {"3,a\n3,b", ":2: the code 3 occurs twice"}}) {
    const std::string message =
        test::error_naming(folder_ / "table.csv", [&, &text = text] { read(text, "4X4_50"); });
    EXPECT_THAT(message, testing::HasSubstr("table.csv" + (expected[0] == ':' ? expected : "")));
    EXPECT_THAT(message, testing::HasSubstr(expected));
  }
  EXPECT_THAT(test::error_of([&] { read("1,a"); }), testing::HasSubstr("'1' is no code"));
  EXPECT_THAT(test::error_of([&] { read("4097,a"); }), testing::HasSubstr("is no code"));
}

}  // namespace
}  // namespace axial::targets
