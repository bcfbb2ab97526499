// SPDX-License-Identifier: GPL-3.0-or-later
// The standard deviation of focal lengths in COLMAP's cameras.txt: a comment that COLMAP skips.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/atomic_file.h"
#include "io/colmap/colmap.h"
#include "io/wrong_input.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class FocalSigmaTest : public testing::Test {
 protected:
  void SetUp() override { folder_ = test::empty_folder(); }
  void TearDown() override { fs::remove_all(folder_); }

  std::vector<ColmapCamera> read(const std::string& comments) {
    test::put(file(), comments +
                          "3 PINHOLE 640 480 500 501 320 240\n"
                          "1 SIMPLE_RADIAL 64 48 50 32 24 -0.1\n");
    return read_colmap_cameras(file());
  }
  std::string error(const std::string& comments) {
    return test::error_of([&] { read(comments); });
  }
  fs::path file() const { return folder_ / "cameras.txt"; }

  fs::path folder_;
};

TEST_F(FocalSigmaTest, IsReadAndWritten) {
  ColmapModel model;
  model.cameras = read("# A list.\n#focal_sigma 1 0.002\n# focal sigma 3 is unknown\n");
  for (int turn = 0; turn < 2; ++turn) {
    EXPECT_EQ(model.cameras[0].focal_sigma, std::nullopt);
    EXPECT_EQ(model.cameras[1].focal_sigma, 0.002);
    write_colmap_text(folder_, model);
    EXPECT_THAT(read_file(file()), HasSubstr("\n# focal_sigma 1 0.002\n"));
    model = read_colmap_model(folder_);
  }
}

TEST_F(FocalSigmaTest, ErrorsNameFileLineAndValue) {
  EXPECT_THAT(error("# focal_sigma 3 -0.1\n"),
              HasSubstr(file().string() + ": line 1: focal_sigma of camera 3 is -0.1"));
  EXPECT_THAT(error("# focal_sigma 3 0\n"), HasSubstr("focal_sigma of camera 3 is 0, expected"));
  EXPECT_THAT(error("\n# focal_sigma 3 1.5\n"),
              HasSubstr("line 2: focal_sigma of camera 3 is 1.5"));
  EXPECT_THAT(error("# focal_sigma 3\n"), HasSubstr("line 1: focal_sigma is missing"));
  EXPECT_THAT(error("# focal_sigma 0.01\n"), HasSubstr("camera id of focal_sigma is '0.01'"));
  EXPECT_THAT(error("# focal_sigma 3 0.01 px\n"), HasSubstr("unexpected 'px'"));
  EXPECT_THAT(error("# focal_sigma 2 0.01\n"), HasSubstr("line 1: focal_sigma names camera 2"));
  EXPECT_THAT(error("# focal_sigma 3 0.01\n# focal_sigma 3 0.01\n"),
              HasSubstr("line 2: focal_sigma of camera 3 occurs twice"));
}

}  // namespace
}  // namespace axial::io
