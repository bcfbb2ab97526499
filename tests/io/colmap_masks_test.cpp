// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/colmap/colmap_masks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/core.hpp>

#include "io/images/image.h"
#include "io/images/masks.h"
#include "support/empty_folder.h"
#include "support/error_of.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using testing::HasSubstr;

constexpr int kColumns = 40, kRows = 30;

class ColmapMasksTest : public test::FolderTest {
 protected:
  void SetUp() override {
    for (const char* name : {"a.jpg", "dive/b.png"}) {
      fs::create_directories((image(name)).parent_path());
      write_png(image(name), cv::Mat3b(kRows, kColumns, cv::Vec3b(9, 9, 9)));
    }
    std::ofstream(image("notes.txt")) << "text";
    masks_ = {folder_ / "images", folder_ / "masks", 0, folder_ / "out"};
    fs::create_directories(masks_.masks / "dive");
  }

  fs::path image(const std::string& name) const { return folder_ / "images" / name; }

  // A mask whose left half has the label 7 and whose right half has the label 300.
  void put_mask(const std::string& name, int scale = 1) const {
    cv::Mat1w labels(kRows / scale, kColumns / scale, std::uint16_t{300});
    labels.colRange(0, labels.cols / 2) = 7;
    write_png(masks_.masks / name, labels);
  }

  // What the masks of COLMAP say about the left and the right half.
  static void expect_halves(const fs::path& file, int left, int right) {
    const cv::Mat mask = cv::Mat(read_label_image(file));
    ASSERT_EQ(mask.size(), cv::Size(kColumns, kRows)) << file;
    EXPECT_EQ(cv::countNonZero(mask.colRange(0, kColumns / 2) != left), 0) << file;
    EXPECT_EQ(cv::countNonZero(mask.colRange(kColumns / 2, kColumns) != right), 0) << file;
    EXPECT_EQ(read_image_header(file).bits, 8);
  }

  ColmapMasks masks_;
};

TEST_F(ColmapMasksTest, HaveColmapsNamesSizesAndBlack) {
  put_mask("a.mask.png");
  put_mask("dive/b.png", 2);
  for (const int label : {7, 300}) {
    masks_.label = label;
    EXPECT_EQ(write_colmap_masks(masks_), 2u);
    for (const char* name : {"a.jpg.png", "dive/b.png.png"})
      expect_halves(masks_.output / name, label == 7 ? 0 : 255, label == 7 ? 255 : 0);
  }
}

TEST_F(ColmapMasksTest, AreFoundByThePrograms) {
  put_mask("a.mask.png");
  put_mask("dive/b.png");
  masks_.label = 7;
  write_colmap_masks(masks_);
  const std::vector<MaskRequest> requests{{image("a.jpg"), {}}, {image("dive/b.png"), {}}};
  const std::vector<FoundMask> found = find_masks(requests, masks_.output);
  EXPECT_EQ(found[0].path, masks_.output / "a.jpg.png");
  EXPECT_EQ(found[1].path, masks_.output / "dive" / "b.png.png");
}

TEST_F(ColmapMasksTest, OneFileIsForAllPhotographs) {
  put_mask("rig.png");
  masks_.masks /= "rig.png";
  masks_.label = 7;
  EXPECT_EQ(write_colmap_masks(masks_), 2u);
  for (const char* name : {"a.jpg.png", "dive/b.png.png"})
    expect_halves(masks_.output / name, 0, 255);
}

TEST_F(ColmapMasksTest, WrongInputIsRefused) {
  const auto error = [&] { return error_of([&] { write_colmap_masks(masks_); }); };
  put_mask("a.mask.png");
  EXPECT_THAT(error(), HasSubstr("no mask for image " + image("dive/b.png").string()));
  write_png(masks_.masks / "dive" / "b.png", cv::Mat1b(kRows, kRows, std::uint8_t{1}));
  EXPECT_THAT(error(), HasSubstr("b.png"));
  put_mask("dive/b.png");
  masks_.output = masks_.masks;
  put_mask("a.jpg.png");
  fs::remove(masks_.masks / "a.mask.png");
  EXPECT_THAT(error(), HasSubstr("a.jpg.png"));
  masks_.images = masks_.masks / "none";
  fs::create_directories(masks_.images);
  EXPECT_THAT(error(), HasSubstr("none: has no photographs"));
}

TEST_F(ColmapMasksTest, AreNotWrittenAmongThePhotographs) {
  put_mask("a.mask.png");
  put_mask("dive/b.png");
  fs::create_directory_symlink(masks_.images, folder_ / "link");
  for (const fs::path& output : {masks_.images, masks_.images / "", masks_.images / "new" / "masks",
                                 folder_ / "link/masks"}) {
    masks_.output = output;
    EXPECT_THAT(error_of([&] { write_colmap_masks(masks_); }),
                HasSubstr("masks would count as photographs"));
    EXPECT_FALSE(fs::exists(output / "a.jpg.png"));
  }
  masks_.output = folder_ / "images2";
  EXPECT_EQ(write_colmap_masks(masks_), 2u);
}

}  // namespace
}  // namespace axial::io
