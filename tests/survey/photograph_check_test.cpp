// SPDX-License-Identifier: GPL-3.0-or-later
#include "survey/photograph_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "belong/hilly_scene.h"
#include "support/captured_events.h"
#include "support/error_of.h"

namespace axial::survey {
namespace {

using test::hilly_scene;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class PhotographCheckTest : public testing::Test {
 protected:
  void SetUp() override {
    scene_ = hilly_scene();
    for (const SceneImage& image : scene_.images)
      photographs_.push_back(test::photograph_of(image));
  }

  std::string warnings() const {
    const test::CapturedEvents events;
    PhotographCheck check(scene_, "scene.mvs");
    for (std::size_t i = 0; i < photographs_.size(); ++i) check.take(i, photographs_[i]);
    check.report(events.context);
    return events.lines;
  }

  std::string error() const {
    const test::CapturedEvents events;
    PhotographCheck check(scene_, "scene.mvs");
    for (std::size_t i = 0; i < photographs_.size(); ++i) check.take(i, photographs_[i]);
    return test::error_of([&] { check.report(events.context); });
  }

  Scene scene_;
  std::vector<cv::Mat1b> photographs_;
};

TEST_F(PhotographCheckTest, PassesThePhotographsOfTheScene) {
  EXPECT_EQ(warnings(), "");
  for (cv::Mat1b& photograph : photographs_) cv::resize(photograph, photograph, {}, 0.5, 0.5);
  EXPECT_EQ(warnings(), "");
}

TEST_F(PhotographCheckTest, NamesExchangedPhotographs) {
  std::swap(photographs_[0], photographs_[3]);
  EXPECT_THAT(warnings(), AllOf(HasSubstr("photo0.jpg: the photograph does not show the ground"),
                                HasSubstr("photo3.jpg: the photograph does not show the ground"),
                                Not(HasSubstr("photo1.jpg")), Not(HasSubstr("photo2.jpg")),
                                Not(HasSubstr("photo4.jpg"))));
}

TEST_F(PhotographCheckTest, NamesBlankPhotographs) {
  photographs_[2].setTo(128);
  EXPECT_THAT(warnings(), AllOf(HasSubstr("photo2.jpg: the photograph is blank"),
                                Not(HasSubstr("photo1.jpg")), Not(HasSubstr("photo3.jpg"))));
  for (cv::Mat1b& photograph : photographs_) photograph.setTo(128);
  EXPECT_THAT(error(), HasSubstr("scene.mvs: 5 of 5 photographs are blank"));
}

TEST_F(PhotographCheckTest, SaysNothingOfPhotographsThatWereNotTaken) {
  photographs_.resize(1);
  EXPECT_EQ(warnings(), "");
}

TEST_F(PhotographCheckTest, SaysNothingWithoutSparsePoints) {
  scene_.points.clear();
  std::swap(photographs_[0], photographs_[3]);
  EXPECT_EQ(warnings(), "");
}

}  // namespace
}  // namespace axial::survey
