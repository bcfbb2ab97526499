// SPDX-License-Identifier: GPL-3.0-or-later
// Colours from a folder of their own: which file belongs to a photograph, and what is read from it.
#include "survey/colors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "support/error_of.h"
#include "survey/fingerprint.h"
#include "survey/photographs.h"
#include "survey/small_survey.h"

namespace axial::survey {
namespace {

using testing::AllOf;
using testing::HasSubstr;

namespace fs = std::filesystem;

const cv::Vec3b kRestored(10, 120, 230);

class ColorsTest : public test::SmallSurvey {
 protected:
  ColorsTest() {
    for (const char* name : {"image0.png", "image2.png"}) write_colors(name, kRestored);
    options_.color_folder = colors_;
  }

  void write_colors(const fs::path& name, const cv::Vec3b& color) const {
    fs::create_directories((colors_ / name).parent_path());
    write_photograph("restored" / name, color);
  }

  const fs::path colors_ = folder_ / "restored";
};

TEST(RestoredName, JpegAndPngKeepTheirNames) {
  for (const char* name : {"a/b.jpg", "b.JPEG", "b.PNG"}) EXPECT_EQ(restored_name(name), name);
  EXPECT_EQ(restored_name("a/b.tif"), "a/b.png");
}

TEST_F(ColorsTest, ThePhotographGivesGreyAndTheFolderColor) {
  const Survey survey = opened();
  EXPECT_EQ(survey.views[1].colors, colors_ / "image2.png");
  const Pixels both = Photographs(survey).read(1, Channels::both);
  EXPECT_EQ(both.color(3, 4), kRestored);
  EXPECT_EQ(both.grey(3, 4), 66);  // of 30 60 90
  EXPECT_TRUE(Photographs(survey).read(1, Channels::grey).color.empty());
}

TEST_F(ColorsTest, TheFolderGivesTheGreyThatIsMatched) {
  const std::string before = fingerprint_of_views(opened());
  options_.match_colors = true;
  Survey survey = opened();
  EXPECT_NE(fingerprint_of_views(survey), before);
  const Pixels both = Photographs(survey).read(1, Channels::both);
  EXPECT_EQ(both.color(3, 4), kRestored);
  EXPECT_EQ(both.grey(3, 4), 140);  // 0.114 * 10 + 0.587 * 120 + 0.299 * 230
  const Pixels grey = Photographs(survey).read(1, Channels::grey);
  EXPECT_EQ(grey.grey(3, 4), 140);
  EXPECT_TRUE(grey.color.empty());
  const std::string print = fingerprint_of_views(survey);
  write_colors("image2.png", {1, 2, 3});
  EXPECT_NE(fingerprint_of_views(survey), print);
  options_.match_colors = false;
  EXPECT_EQ(fingerprint_of_views(opened()), before);
  write_colors("image2.png", kRestored);
  // The photograph itself is not read.
  fs::resize_file(folder_ / "image2.png", fs::file_size(folder_ / "image2.png") / 2);
  EXPECT_EQ(Photographs(survey).read(1, Channels::grey).grey(3, 4), 140);
}

TEST_F(ColorsTest, TheLongestEndOfThePathCounts) {
  const fs::path end = folder_.filename();
  write_colors(folder_.parent_path().filename() / end / "image0.png", {1, 2, 3});
  write_colors(end / "image0.png", {4, 5, 6});
  write_colors(end / "image2.png", {4, 5, 6});
  const Survey survey = opened();
  EXPECT_EQ(Photographs(survey).read(0, Channels::color).color(0, 0), cv::Vec3b(1, 2, 3));
  EXPECT_EQ(Photographs(survey).read(1, Channels::color).color(0, 0), cv::Vec3b(4, 5, 6));
}

// The restored picture has neither mask, nor transparency, nor a border.
TEST_F(ColorsTest, MaskTransparencyAndBorderAreThoseOfThePhotograph) {
  use_part_of_first_photograph();
  Survey survey = opened();
  const Pixels restored = Photographs(survey).read(0, Channels::color);
  EXPECT_EQ(restored.color(0, 0), kRestored);
  survey.views[0].colors.clear();
  const cv::Mat1b mask = Photographs(survey).read(0, Channels::color).mask;
  EXPECT_EQ(cv::norm(restored.mask, mask, cv::NORM_INF), 0);
  EXPECT_GT(cv::countNonZero(mask), 0);
}

TEST_F(ColorsTest, APhotographThatIsNotNeededIsNotDecoded) {
  const Survey survey = opened();
  fs::resize_file(folder_ / "image0.png", fs::file_size(folder_ / "image0.png") / 2);
  EXPECT_EQ(Photographs(survey).read(0, Channels::color).color(0, 0), kRestored);
  EXPECT_THAT(test::error_of([&] { Photographs(survey).read(0, Channels::both); }),
              HasSubstr("image0.png"));
}

// Photographs of 12 bits have restored pictures that use all bits.
TEST_F(ColorsTest, RestoredPicturesUseAllBits) {
  io::write_png(folder_ / "image0.png", cv::Mat(kSize, CV_16UC3, cv::Scalar::all(0x0fff)));
  io::write_png(colors_ / "image0.png", cv::Mat(kSize, CV_16UC3, cv::Scalar::all(0x4000)));
  const Survey survey = opened();
  EXPECT_EQ(survey.bit_depth, 12);
  const Pixels both = Photographs(survey).read(0, Channels::both);
  EXPECT_EQ(both.grey(0, 0), 255);
  EXPECT_EQ(both.color(0, 0), cv::Vec3b(0x40, 0x40, 0x40));
}

TEST_F(ColorsTest, TheirMemoryIsCounted) {
  const std::uint64_t with_8_bits = Photographs(opened()).bytes_to_read_color();
  io::write_png(colors_ / "image0.png", cv::Mat(kSize, CV_16UC3, cv::Scalar::all(0x4000)));
  const Survey survey = opened();
  EXPECT_GT(Photographs(survey).bytes_to_read_color(), with_8_bits);
  EXPECT_EQ(survey.views[0].decoding_bytes(), io::bytes_needed(survey.views[0].colors_header));
}

TEST_F(ColorsTest, TheyAreInputs) {
  EXPECT_THAT(
      test::error_of([&] { opened().keep_inputs(std::vector{colors_ / "image2.png"}, "output"); }),
      AllOf(HasSubstr("output "), HasSubstr("image2.png")));
}

TEST_F(ColorsTest, WrongFoldersAreErrors) {
  io::write_png(colors_ / "image2.png", cv::Mat3b(kSize.height, kSize.width / 2));
  EXPECT_THAT(error(), HasSubstr("restored/image2.png: is 48x72, but its photograph "));
  fs::remove(colors_ / "image2.png");
  EXPECT_THAT(error(), AllOf(HasSubstr("color_folder"), HasSubstr("no colours for image"),
                             HasSubstr("/image2.png: looked for ")));
  options_.color_folder = folder_ / "none";
  EXPECT_THAT(error(), HasSubstr("none: is not a folder"));
}

TEST_F(ColorsTest, NoFileBelongsToTwoPhotographs) {
  Survey survey = opened();
  survey.views[0].file = folder_ / "other" / "image2.png";
  EXPECT_THAT(test::error_of([&] { find_colors(survey); }),
              HasSubstr("image2.png: would give the colours of both "));
}

}  // namespace
}  // namespace axial::survey
