// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibrate/photographs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "base/atomic_file.h"
#include "io/images/image.h"
#include "support/empty_folder.h"
#include "support/error_of.h"
#include "support/photograph.h"

namespace axial::calibrate {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class Photographs : public ::testing::Test {
 protected:
  fs::path folder_ = test::empty_folder();

  void TearDown() override { fs::remove_all(folder_); }

  fs::path file(const std::string& name) {
    write_atomically(folder_ / name, "");
    return folder_ / name;
  }
  std::string error(const std::vector<fs::path>& input) {
    return test::error_of([&] { photographs_in(input); });
  }
};

TEST_F(Photographs, AreFilesAsGivenAndImagesOfFoldersByName) {
  make_folder(folder_ / "dive");
  for (const char* name : {"dive/b.JPG", "dive/a.tiff", "dive/notes.txt", "other.raw"}) file(name);
  make_folder(folder_ / "dive" / "c.jpg");
  const std::vector<fs::path> input{folder_ / "other.raw", folder_ / "dive"};
  EXPECT_THAT(photographs_in(input), ElementsAre(folder_ / "other.raw", folder_ / "dive" / "a.tiff",
                                                 folder_ / "dive" / "b.JPG"));
}

TEST_F(Photographs, MissingOnesAreNamed) {
  EXPECT_THAT(error({folder_ / "none.jpg"}), HasSubstr("none.jpg: does not exist"));
  make_folder(folder_ / "empty");
  EXPECT_THAT(error({folder_ / "empty"}), HasSubstr("empty: contains no photographs"));
}

// The first photograph shows the whole board, the second one only grey ground.
class Views : public Photographs {
 protected:
  const Board board_ = parse_board("checkerboard:5x4:0.03");
  const io::ColmapCamera lens_{1, "PINHOLE", 320, 240, {300, 300, 160, 120}};
  std::vector<fs::path> photographs_;

  void SetUp() override {
    const CameraModel camera{320, 240, {300, 300, 159.5, 119.5}, {}};
    const auto squares = test::checkerboard(board_.columns, board_.rows, board_.size);
    const auto ground = [](double, double) { return 0.4; };
    const Pose before{Eigen::Matrix3d::Identity(), {0.06, 0.045, -0.35}};
    add("board.png", test::photograph(camera, before, squares));
    add("ground.png", test::photograph(camera, before, ground));
  }

  void add(const std::string& name, const cv::Mat1b& picture) {
    photographs_.push_back(folder_ / name);
    io::write_png(photographs_.back(), picture);
  }
};

TEST_F(Views, KeepTheirOrderAndAreEmptyWithoutTheBoard) {
  std::ranges::reverse(photographs_);
  const std::vector<View> views = find_views(photographs_, board_, lens_);
  ASSERT_EQ(views.size(), 2u);
  EXPECT_EQ(views[0].image, "ground.png");
  EXPECT_THAT(views[0].corners, IsEmpty());
  EXPECT_EQ(views[1].image, "board.png");
  EXPECT_EQ(views[1].corners.size(), corners_of(board_).size());
}

TEST_F(Views, TheFirstPhotographOfAnotherSizeIsNamed) {
  add("small.png", cv::Mat1b(120, 160, std::uint8_t{100}));
  add("tiny.png", cv::Mat1b(12, 16, std::uint8_t{100}));
  const std::string error = test::error_of([&] { find_views(photographs_, board_, lens_); });
  EXPECT_THAT(error, HasSubstr("small.png: is 160 x 120 pixels, but the lens is calibrated for "
                               "320 x 240"));
  EXPECT_THAT(error, Not(HasSubstr("tiny.png")));
}

}  // namespace
}  // namespace axial::calibrate
