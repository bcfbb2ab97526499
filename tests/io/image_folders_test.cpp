// SPDX-License-Identifier: GPL-3.0-or-later
#include "openmvs/private/image_folders.h"

#include <gmock/gmock.h>

#include "io/wrong_input.h"
#include "support/captured_events.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

using testing::ElementsAre;

// A working folder `here`, and a scene in a/b/c/d/project/run. Photographs are in the folder that a
// test names.
class ImageFoldersTest : public test::FolderTest {
 protected:
  void SetUp() override {
    folder_ = fs::canonical(folder_);
    fs::create_directories(here());
    fs::create_directories(run());
  }

  fs::path here() const { return folder_ / "here"; }
  fs::path above() const { return folder_ / "a/b/c/d/project"; }
  fs::path run() const { return above() / "run"; }

  static std::string photograph(const fs::path& folder, const std::string& name) {
    fs::create_directories((folder / name).parent_path());
    test::put(folder / name, "a photograph");
    return (folder / name).string();
  }
  std::vector<std::string> find(const std::vector<std::string>& names) const {
    return find_files_of_scene(here(), run() / "scene.mvs", names, "images", log_.context);
  }

  test::CapturedEvents log_;
};

TEST_F(ImageFoldersTest, TheWorkingFolderIsFirst) {
  const std::string usual = photograph(here(), "images/a.jpg");
  EXPECT_THAT(find({"images/a.jpg", "images/./x/../a.jpg", ""}), ElementsAre(usual, usual, ""));
  EXPECT_EQ(log_.lines, "");
}

TEST_F(ImageFoldersTest, TheFolderOfTheSceneIsNext) {
  const std::string beside = photograph(run(), "images/a.jpg");
  photograph(above(), "images/a.jpg");
  EXPECT_THAT(find({"images/a.jpg"}), ElementsAre(beside));
  EXPECT_THAT(log_.lines,
              HasSubstr("scene.mvs: the paths of its images start at " + run().string() + "\n"));
}

TEST_F(ImageFoldersTest, AFolderThatHasAllFilesIsTaken) {
  const std::string a = photograph(above(), "images/a.jpg");
  const std::string b = photograph(above(), "images/b.jpg");
  photograph(here(), "images/a.jpg");
  const std::string other = photograph(run(), "images/b.jpg");
  EXPECT_THAT(find({"images/a.jpg", "images/b.jpg"}), ElementsAre(a, b));
  EXPECT_THAT(log_.lines, HasSubstr("the paths of its images start at " + above().string()));
  EXPECT_THAT(log_.lines, HasSubstr(a + " is used, although " + here().string()));
}

TEST_F(ImageFoldersTest, TheFolderWithTheMostFilesIsTaken) {
  const std::string a = photograph(above(), "a.jpg"), b = photograph(above(), "b.jpg");
  photograph(run(), "c.jpg");
  EXPECT_THAT(find({"a.jpg", "b.jpg", "c.jpg"}), ElementsAre(a, b, (above() / "c.jpg").string()));
}

TEST_F(ImageFoldersTest, OnlyNearFoldersAboveTheSceneAreSearched) {
  const std::string highest = photograph(folder_ / "a/b/c", "a.jpg");
  photograph(folder_ / "a/b", "b.jpg");
  EXPECT_THAT(find({"a.jpg"}), ElementsAre(highest));
  EXPECT_THAT(find({"b.jpg"}), ElementsAre((here() / "b.jpg").string()));
}

TEST_F(ImageFoldersTest, AbsoluteNamesBelowTheWorkingFolderAreFound) {
  const std::string found = photograph(above(), "images/a.jpg");
  const std::string elsewhere = (folder_ / "elsewhere/images/a.jpg").string();
  EXPECT_THAT(find({(here() / "images/a.jpg").string(), elsewhere}), ElementsAre(found, elsewhere));
}

TEST_F(ImageFoldersTest, AnAbsoluteNameOfAFileIsThisFile) {
  const std::string a = photograph(here(), "images/a.jpg");
  photograph(run(), "images/a.jpg");
  const std::string b = photograph(run(), "images/b.jpg");
  const std::string missing = (here() / "images/b.jpg").string();
  EXPECT_THAT(find({a, missing}), ElementsAre(a, b));
}

TEST_F(ImageFoldersTest, FilesThatAreNowhereAreInTheWorkingFolder) {
  EXPECT_THAT(find({"images/a.jpg"}), ElementsAre((here() / "images/a.jpg").string()));
  EXPECT_EQ(log_.lines, "");
}

TEST_F(ImageFoldersTest, TwoFilesOfOneNameAreOneWarning) {
  for (const char* name : {"a.jpg", "b.jpg"}) {
    photograph(here(), name);
    photograph(run(), name);
  }
  EXPECT_THAT(find({"a.jpg", "b.jpg"}),
              ElementsAre((here() / "a.jpg").string(), (here() / "b.jpg").string()));
  EXPECT_THAT(log_.lines,
              HasSubstr("a.jpg is used, although " + (run() / "a.jpg").string() + " exists, too"));
  EXPECT_EQ(log_.lines.find("b.jpg"), std::string::npos);
}

TEST_F(ImageFoldersTest, TwoNamesOfOneFileAreNoWarning) {
  photograph(run(), "a.jpg");
  fs::create_hard_link(run() / "a.jpg", here() / "a.jpg");
  find({"a.jpg"});
  EXPECT_EQ(log_.lines, "");
}

}  // namespace
}  // namespace axial::io
