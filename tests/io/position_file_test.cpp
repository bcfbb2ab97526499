// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cameras/position_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <set>

#include "base/atomic_file.h"
#include "io/wrong_input.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using testing::HasSubstr;

// A random name without line ends and without blanks at its ends.
std::string any_name() {
  const auto name = *rc::gen::nonEmpty(
      rc::gen::container<std::string>(rc::gen::element('a', ' ', '#', '"', ',', '7', '\t', '.')));
  RC_PRE(std::string(" \t").find(name.front()) == std::string::npos);
  RC_PRE(std::string(" \t").find(name.back()) == std::string::npos);
  return name;
}

std::string in_quotes(const std::string& name) {
  std::string text = "\"";
  for (const char c : name) text += c == '"' ? std::string("\"\"") : std::string(1, c);
  return text + '"';
}

std::vector<NamedPosition> positions_in(const std::string& text,
                                        const std::set<std::string>& images = {}) {
  const fs::path folder = test::empty_folder();
  test::put(folder / "positions.txt", text);
  const auto positions = read_positions(
      folder / "positions.txt", [&](const std::string& name) { return images.contains(name); });
  fs::remove_all(folder);
  return positions;
}

// Names that the model has need no quotes; every name can be quoted.
RC_GTEST_PROP(Positions, KeepAnyName, (double x, double y, double z)) {
  RC_PRE(std::isfinite(x) && std::isfinite(y) && std::isfinite(z));
  const std::string name = any_name();
  const bool known = *rc::gen::arbitrary<bool>();
  const std::string written = known && *rc::gen::arbitrary<bool>() ? name : in_quotes(name);
  const std::string comment = *rc::gen::element<std::string>("", "  ", "\r", " # here", "\t#1");
  const auto read = positions_in(fmt::format("# X\n\n{} {} {}\t{}{}", written, x, y, z, comment),
                                 known ? std::set{name} : std::set<std::string>{});
  RC_ASSERT(read.size() == 1u);
  RC_ASSERT(read[0].name == name);
  RC_ASSERT(read[0].position == Eigen::Vector3d(x, y, z));
  RC_ASSERT(read[0].known == known);
  RC_ASSERT(read[0].line == 3);
}

RC_GTEST_PROP(Lists, KeepAnyName, ()) {
  std::vector<std::string> names;
  std::string list;
  for (int i = *rc::gen::inRange(1, 5); i-- > 0;) {
    names.push_back(any_name());
    const bool plain = names.back().find_first_of(",\"") == std::string::npos;
    list += (list.empty() ? "" : ",") + (plain ? names.back() : in_quotes(names.back()));
  }
  RC_ASSERT(split_list(list, "") == names);
}

TEST(Lists, NameAnOpenQuote) {
  EXPECT_EQ(error_of([] { split_list("a,\"b,c", "--scale-from"); }),
            "--scale-from: a quote is not closed");
  EXPECT_EQ(split_list("", ""), std::vector<std::string>{""});
}

// A '#' belongs to a name only if the model has a name with it.
TEST(Positions, CommentsAreNoNames) {
  const std::string text =
      "# name x y z\n#1.jpg 1 2 3\na.jpg 1 2 3 # 4 5 6\na.jpg 1 2 3 #b 4 5 6\n";
  const auto of = [&](const std::set<std::string>& images) {
    std::vector<std::string> names;
    for (const NamedPosition& position : positions_in(text, images))
      names.push_back(fmt::format("{}={}", position.name, position.position.x()));
    return names;
  };
  EXPECT_EQ(of({"a.jpg"}), (std::vector<std::string>{"a.jpg=1", "a.jpg=1"}));
  EXPECT_EQ(of({}), (std::vector<std::string>{"a.jpg=1", "a.jpg=1"}));
  EXPECT_EQ(of({"#1.jpg", "a.jpg 1 2 3 #b"}),
            (std::vector<std::string>{"#1.jpg=1", "a.jpg=1", "a.jpg 1 2 3 #b=4"}));
}

TEST(Positions, NameTheLineThatIsWrong) {
  for (const char* line :
       {"a.jpg 1 2", "1 2 3", "a.jpg 1 2 x", "a.jpg", "\"a.jpg\"", "a.jpg,1,2,3", "a.jpg 1 2 # 3"})
    EXPECT_THAT(error_of([&] { positions_in("b 1 2 3\n" + std::string(line) + "\n"); }),
                HasSubstr("positions.txt:2: must be NAME X Y Z"))
        << line;
  EXPECT_THAT(error_of([&] { positions_in("a.jpg 1 inf 3"); }),
              HasSubstr("positions.txt:1: 'inf' is not finite"));
}

}  // namespace
}  // namespace axial::io
