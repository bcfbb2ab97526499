// SPDX-License-Identifier: GPL-3.0-or-later
// Opening a survey: its files, the photographs that are used, and their masks.
#include "survey/survey.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/atomic_file.h"
#include "support/error_of.h"
#include "survey/fingerprint.h"
#include "survey/small_survey.h"

namespace axial::survey {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

using SurveyTest = test::SmallSurvey;

std::vector<std::size_t> images_of(const Survey& survey) {
  std::vector<std::size_t> images;
  for (const View& view : survey.views) images.push_back(view.image);
  return images;
}

TEST_F(SurveyTest, CalibratedImagesAreViewsAtTheWorkingResolution) {
  options_.resolution = {1, 1, 1 << 16};
  const Survey survey = opened();
  EXPECT_THAT(images_of(survey), ElementsAre(0u, 2u));
  EXPECT_EQ(survey.views[1].id, 12u);
  EXPECT_EQ(survey.views[1].camera.width, 48);
  EXPECT_EQ(survey.views[1].pixels(), 48u * 36u);
  EXPECT_EQ(posed_cameras(survey)[1].pose.centre, survey.scene.images[2].pose.centre);
}

TEST_F(SurveyTest, AListNamesTheImagesToUse) {
  options_.views_file = folder_ / "views.txt";
  for (const std::string word : {"12", "image2.png", "image2", "image1\n12"}) {
    write_atomically(options_.views_file, "# comment\n\n" + word + " \r\n");
    EXPECT_THAT(images_of(opened()), ElementsAre(2u)) << word;
  }
  write_atomically(options_.views_file, "12\nimage7\n");
  EXPECT_THAT(error(), HasSubstr("views.txt: line 2: no image has the ID or the name image7"));
  write_atomically(options_.views_file, "image1\n");
  EXPECT_THAT(error(), HasSubstr("scene.mvs: has no calibrated image to use"));
}

TEST_F(SurveyTest, NoInputIsOverwritten) {
  options_.ignore_mask_label = 0;
  options_.views_file = folder_ / "views.txt";
  write_atomically(options_.views_file, "12\n");
  write_mask("image2.mask.png", 1);
  Survey survey = opened();
  survey.scene = {};
  write_atomically(folder_ / "cloud.ply", "");
  survey.add_inputs(std::vector{folder_ / "cloud.ply"});
  for (const char* name :
       {"scene.mvs", "image2.png", "image2.mask.png", "views.txt", "cloud.ply"}) {
    const std::vector outputs{folder_ / "new.ply", folder_ / name};
    EXPECT_THAT(test::error_of([&] { survey.keep_inputs(outputs, "output"); }),
                AllOf(HasSubstr("output "), HasSubstr(name)));
  }
  survey.keep_inputs(std::vector{folder_ / "new.ply"}, "output");
  EXPECT_THAT(test::error_of([&] {
                survey.keep_inputs(std::vector{folder_ / "image2.png" / "new.ply"}, "output");
              }),
              HasSubstr("new.ply"));
}

TEST_F(SurveyTest, TooLittleMemoryIsAnErrorUnlessThereIsNoLimit) {
  const Context context({}, {}, {MemoryBudget::of_program(1)});
  EXPECT_THAT(test::error_of([&] { open_scene(options_, context); }),
              AllOf(HasSubstr("max_memory"), HasSubstr("scene.mvs")));
  EXPECT_EQ(opened().views.size(), 2u);
}

TEST_F(SurveyTest, AFolderMustHaveAMaskForEachPhotograph) {
  const std::filesystem::path masks = folder_ / "masks";
  std::filesystem::create_directories(masks);
  options_.mask_folder = masks;
  EXPECT_TRUE(opened().views[0].mask.empty());
  EXPECT_THAT(events_.lines, HasSubstr("is not used, because ignore_mask_label is -1"));
  options_.ignore_mask_label = 0;
  EXPECT_THAT(error(), AllOf(HasSubstr("mask_folder"), HasSubstr("no mask for image")));
  for (const char* name : {"masks/image0.png", "masks/image2.png"}) write_mask(name, 1);
  EXPECT_EQ(opened().views[1].mask, masks / "image2.png");
}

TEST_F(SurveyTest, APhotographWithoutMaskIsAWarning) {
  options_.ignore_mask_label = 0;
  write_mask("image0.mask.png", 1);
  const Survey survey = opened();
  EXPECT_EQ(survey.views[0].mask, folder_ / "image0.mask.png");
  EXPECT_TRUE(survey.views[1].mask.empty());
  EXPECT_THAT(events_.lines, HasSubstr("image2.png: no mask: looked for"));
}

TEST_F(SurveyTest, TheFingerprintDependsOnPhotographsMasksAndCameras) {
  const Survey survey = opened();
  std::set<std::string> prints{fingerprint_of_views(survey)};
  const auto expect_new = [&](const Survey& changed, const char* what) {
    EXPECT_TRUE(prints.insert(fingerprint_of_views(changed)).second) << what;
  };
  Survey camera = survey, pose = survey, mask = survey, label = survey, border = survey;
  camera.views[0].camera.lens.fx += 1e-9;
  pose.views[0].pose.centre.x() += 1e-9;
  write_mask("other.png", 1);
  mask.views[0].mask = folder_ / "other.png";
  label.options.ignore_mask_label = 3;
  border.options.ignore_black_border = true;
  expect_new(camera, "camera");
  expect_new(pose, "pose");
  expect_new(mask, "mask");
  expect_new(label, "label");
  expect_new(border, "border");
  write_photograph("image0.png", cv::Vec3b(1, 2, 3));
  expect_new(survey, "pixels");
}

}  // namespace
}  // namespace axial::survey
