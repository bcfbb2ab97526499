// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/program/output_name.h"

#include <gmock/gmock.h>

#include "support/error_of.h"

namespace axial {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST(OutputName, AKnownExtensionIsReplaced) {
  for (const char* name : {"a.mvs", "a.ply", "a.obj", "a.glb", "a.gltf", "a.MVS", "a.Ply", "a"})
    EXPECT_EQ(with_extension(fs::path("d.x") / name, ".mvs"), fs::path("d.x/a.mvs")) << name;
}

TEST(OutputName, EveryOtherDotBelongsToTheName) {
  for (const char* name : {"reef.2024", "reef.v2", "reef.tile1-4", ".reef", "reef.", "a.jpg"})
    EXPECT_EQ(with_extension(name, ".housing.json"), fs::path(name + std::string(".housing.json")));
  EXPECT_EQ(without_known_extension("reef.2024.mvs"), fs::path("reef.2024"));
  EXPECT_EQ(without_known_extension("reef.2024"), fs::path("reef.2024"));
}

TEST(OutputName, NamesWithControlCharactersAreRefused) {
  CommonOptions common;
  common.working_folder = "/w";
  for (const std::string name : {"a\nb", "a\rb", "a\tb", "\x01", "b\x7f.ply"}) {
    EXPECT_THAT(test::error_of([&] { output_in_working_folder(common, name, "--json"); }),
                HasSubstr("--json"))
        << name;
    EXPECT_THAT(test::error_of([&] { folder_in_working_folder(common, name, "--report"); }),
                HasSubstr("control character"));
    EXPECT_THAT(test::error_of([&] { output_or("", name, "--output-file"); }),
                HasSubstr("control character"));
  }
  EXPECT_EQ(output_in_working_folder(common, "Öl 7.ply", "-o"), fs::path("/w/Öl 7.ply"));
  EXPECT_EQ(output_or("", "/x/y", "-o"), fs::path("/x/y"));
  EXPECT_EQ(output_or("/w/z", "/x/y", "-o"), fs::path("/w/z"));
}

TEST(OutputName, FormatsThatAreNotWrittenAreNamed) {
  EXPECT_THAT(test::error_of([] { refuse_other_format("m.STL", "--output-file"); }),
              HasSubstr("--output-file m.STL: .stl files are not written"));
  EXPECT_THAT(
      test::error_of([] { refuse_other_format("c.Las", "--output-file"); }),
      HasSubstr("--output-file c.Las: a .las file is written by TransformScene -i cloud.ply "
                "alone"));
  refuse_other_format("scan.v2", "--output-file");
}

}  // namespace
}  // namespace axial
