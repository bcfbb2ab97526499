// SPDX-License-Identifier: GPL-3.0-or-later
// The pixels of photographs, and the pixels that are left out.
#include "survey/photographs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "support/error_of.h"
#include "survey/image_store.h"
#include "survey/small_survey.h"

namespace axial::survey {
namespace {

using testing::HasSubstr;

namespace fs = std::filesystem;

using PhotographsTest = test::SmallSurvey;

TEST_F(PhotographsTest, HaveTheChannelsThatAreAskedFor) {
  options_.resolution = {1, 1, 1 << 16};
  const Survey survey = opened();
  const Photographs photographs(survey);
  const cv::Size half(kSize.width / 2, kSize.height / 2);
  const Pixels both = photographs.read(1, Channels::both);
  EXPECT_EQ(both.grey.size(), half);
  EXPECT_EQ(both.color.size(), half);
  EXPECT_TRUE(both.mask.empty());
  EXPECT_EQ(both.color(3, 4), cv::Vec3b(30, 60, 90));
  EXPECT_EQ(both.grey(3, 4), 66);  // 0.114 B + 0.587 G + 0.299 R = 65.55
  EXPECT_TRUE(photographs.read(1, Channels::grey).color.empty());
  EXPECT_TRUE(photographs.read(1, Channels::color).grey.empty());
}

TEST_F(PhotographsTest, LeaveOutMaskTransparencyAndBlackBorder) {
  use_part_of_first_photograph();
  const Survey survey = opened();
  EXPECT_TRUE(survey.views[0].masked());
  const cv::Mat1b mask = Photographs(survey).read(0, Channels::color).mask;
  ASSERT_EQ(mask.size(), kSize);
  constexpr int kMargin = 3;  // of the black border
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      const bool used =
          y >= kSize.height / 4 && x >= kSize.width / 2 && x < kSize.width - 10 - kMargin;
      ASSERT_EQ(mask(y, x) != 0, used) << x << " " << y;
    }
}

TEST_F(PhotographsTest, AMaskHasTheShapeOfItsPhotograph) {
  options_.ignore_mask_label = 0;
  io::write_png(folder_ / "image0.mask.png", cv::Mat1b(kSize.height, kSize.width / 2, uchar{1}));
  const Survey survey = opened();
  EXPECT_THAT(test::error_of([&] { Photographs(survey).read(0, Channels::grey); }),
              HasSubstr("image0.mask.png"));
}

TEST_F(PhotographsTest, ALabelThatNoMaskHasIsAWarning) {
  write_mask("image0.mask.png", 7);
  write_mask("image2.mask.png", 9);
  for (const int label : {5, 7}) {
    options_.ignore_mask_label = label;
    const Survey survey = opened();
    events_.lines.clear();
    ImageStore images(survey, Channels::grey, 2);
    images.check_all(1, events_.context);
    const std::string words = "ignore_mask_label 5: no mask has this label; " +
                              (folder_ / "image0.mask.png").string() +
                              " and the other masks have 0, 7, 9\n";
    if (label == 5)
      EXPECT_THAT(events_.lines, HasSubstr(words));
    else
      EXPECT_THAT(events_.lines, Not(HasSubstr("no mask has this label")));
  }
}

TEST_F(PhotographsTest, ABadPhotographIsFoundBeforeTheWork) {
  const Survey survey = opened();
  fs::resize_file(folder_ / "image2.png", fs::file_size(folder_ / "image2.png") / 2);
  ImageStore images(survey, Channels::grey, 2);
  EXPECT_THAT(test::error_of([&] { images.check_all(2, {}); }), HasSubstr("image2.png"));
}

// More than half of the photographs are blank.
TEST_F(PhotographsTest, AreComparedWithEachOtherWithoutTheScene) {
  for (const bool compared : {false, true}) {
    options_.compares_photographs = compared;
    Survey survey = opened();
    survey.scene = {};
    const Photographs photographs(survey);
    for (std::size_t v = 0; v < survey.views.size(); ++v) photographs.read(v, Channels::color);
    if (compared)
      EXPECT_THAT(test::error_of([&] { photographs.report(events_.context); }),
                  HasSubstr("are blank"));
    else
      photographs.report(events_.context);
  }
}

}  // namespace
}  // namespace axial::survey
