// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/same_file.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <vector>

#include "base/atomic_file.h"
#include "support/empty_folder.h"
#include "support/error_of.h"

namespace axial {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

struct TwoFiles : testing::Test {
  TwoFiles() : folder(test::empty_folder()), input(folder / "a"), other(folder / "b") {
    write_atomically(input, "x");
    write_atomically(other, "x");
  }
  std::string error(const fs::path& output) const {
    const std::array inputs{folder / "missing", fs::path(), other, input};
    return test::error_of([&] { require_not_an_input(output, inputs, "--output-file"); });
  }
  fs::path folder, input, other;
};

// An input is found under every name that it has.
TEST_F(TwoFiles, AnInputByAnyNameIsRefused) {
  fs::create_symlink(input, folder / "symbolic");
  fs::create_hard_link(input, folder / "hard");
  for (const fs::path& name : {input, folder / "." / "a", folder / "symbolic", folder / "hard"})
    EXPECT_THAT(error(name), AllOf(HasSubstr("--output-file " + name.string()),
                                   HasSubstr(name == input ? "an input" : input.string())));
}

// A file with the same content is another file, and a file that does not exist is no input.
TEST_F(TwoFiles, OtherFilesPass) {
  const std::array inputs{input};
  EXPECT_NO_THROW(require_not_an_input(other, inputs, "-o"));
  EXPECT_NO_THROW(require_not_an_input(folder / "new", inputs, "-o"));
  EXPECT_NO_THROW(require_not_an_input(folder / "missing", std::array{folder / "missing"}, "-o"));
  EXPECT_NO_THROW(require_not_an_input({}, std::array{fs::path()}, "-o"));
}

TEST(Outputs, TwoOfTheSamePathAreRefused) {
  std::vector<NamedOutput> outputs{{"--json", "a"}, {"--cloud", "b"}, {"--off", ""}, {"-x", ""}};
  EXPECT_NO_THROW(require_different(outputs));
  outputs.push_back({"--picture", "a"});
  EXPECT_EQ(test::error_of([&] { require_different(outputs); }),
            "--picture a: is also a file of --json");
}

}  // namespace
}  // namespace axial
