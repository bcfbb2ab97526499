// SPDX-License-Identifier: GPL-3.0-or-later
#include "private/openmvs/image_folders.h"

#include <gmock/gmock.h>

#include "base/log.h"
#include "io/wrong_input.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// A working folder `here`, and a scene in project/run. Photographs are in the folder that a test
// names.
class ImageFoldersTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::canonical(test::empty_folder());
    fs::create_directories(folder_ / "here");
    fs::create_directories(folder_ / "project/run");
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string photograph(const fs::path& below) {
    fs::create_directories((folder_ / below).parent_path());
    test::put(folder_ / below, "a photograph");
    return (folder_ / below).string();
  }
  ImageFolders folders() const { return {folder_ / "here", folder_ / "project/run/scene.mvs"}; }

  fs::path folder_;
};

TEST_F(ImageFoldersTest, TheWorkingFolderIsFirst) {
  const std::string usual = photograph("here/images/a.jpg");
  const LogCapture log;
  EXPECT_EQ(folders().find("images/a.jpg"), usual);
  EXPECT_EQ(folders().find("images/./x/../a.jpg"), usual);
  EXPECT_EQ(log.text(), "");
}

TEST_F(ImageFoldersTest, TheSceneAndTheFoldersAboveAreNext) {
  const std::string above = photograph("project/images/a.jpg");
  const std::string beside = photograph("project/run/images/b.jpg");
  photograph("project/images/b.jpg");
  ImageFolders folders = this->folders();
  const LogCapture log;
  EXPECT_EQ(folders.find("images/a.jpg"), above);
  EXPECT_EQ(folders.find("images/b.jpg"), beside);  // the nearest one
  const std::string told = "scene.mvs: the paths of its images start at ";
  EXPECT_THAT(log.text(), HasSubstr(told + (folder_ / "project").string()));
  EXPECT_EQ(log.text().find(told), log.text().rfind(told));  // once
}

TEST_F(ImageFoldersTest, AbsoluteNamesBelowTheWorkingFolderAreFound) {
  const std::string above = photograph("project/images/a.jpg");
  EXPECT_EQ(folders().find(folder_ / "here/images/a.jpg"), above);
  const std::string other = (folder_ / "elsewhere/images/a.jpg").string();
  EXPECT_EQ(folders().find(other), other);
}

TEST_F(ImageFoldersTest, AFileThatIsNowhereIsInTheWorkingFolder) {
  const LogCapture log;
  EXPECT_EQ(folders().find("images/a.jpg"), (folder_ / "here/images/a.jpg").string());
  EXPECT_EQ(log.text(), "");
}

TEST_F(ImageFoldersTest, TwoFilesOfOneNameAreOneWarning) {
  for (const char* name : {"a.jpg", "b.jpg"}) {
    photograph(fs::path("here") / name);
    photograph(fs::path("project/run") / name);
  }
  ImageFolders folders = this->folders();
  const LogCapture log;
  for (const char* name : {"a.jpg", "b.jpg"})
    EXPECT_EQ(folders.find(name), (folder_ / "here" / name).string());
  EXPECT_THAT(log.text(), HasSubstr("a.jpg is used, although " +
                                    (folder_ / "project/run/a.jpg").string() + " exists, too"));
  EXPECT_EQ(log.text().find("b.jpg"), std::string::npos);
}

TEST_F(ImageFoldersTest, TwoNamesOfOneFileAreNoWarning) {
  photograph("project/run/a.jpg");
  fs::create_hard_link(folder_ / "project/run/a.jpg", folder_ / "here/a.jpg");
  const LogCapture log;
  folders().find("a.jpg");
  EXPECT_EQ(log.text(), "");
}

}  // namespace
}  // namespace axial::io
