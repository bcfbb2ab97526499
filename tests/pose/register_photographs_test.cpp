// SPDX-License-Identifier: GPL-3.0-or-later
// Photographs without poses among refined ones.
#include "pose/registration/register_photographs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/parallel.h"
#include "pose/matched_survey.h"

namespace axial::pose {
namespace {

using testing::camera_behind;
using ::testing::ElementsAre;
using testing::flat_port;
using ::testing::HasSubstr;
using testing::MatchedSurvey;

// A strip of 21 photographs with noise of 0.3 px.
Bundle strip() {
  return testing::survey(camera_behind(flat_port(3, 0.05)),
                         {.images = 21, .points = 600, .noise = 0.3});
}

RegisterOptions with_scale_of(const Bundle& truth, std::size_t first, std::size_t second) {
  RegisterOptions options;
  const double length = (truth.images[first].pose.centre - truth.images[second].pose.centre).norm();
  options.adjust.distances = {{KnownDistance::Between::images, first, second, length, 1e-4}};
  return options;
}

TEST(RegisterPhotographs, GivesLeftOutPhotographsTheirPoses) {
  MatchedSurvey survey = testing::matched_survey(strip(), {2, 7, 8, 9, 15, 20});
  const RegisterReport report =
      register_photographs(survey.bundle, survey.matches, with_scale_of(survey.truth, 0, 19));
  EXPECT_THAT(report.registered, ElementsAre(2, 7, 8, 9, 15, 20));
  EXPECT_TRUE(report.left_out.empty());
  const auto errors = testing::pose_errors(survey.bundle, survey.truth, false);
  EXPECT_LT(errors.centre_rms, 0.001);
  EXPECT_LT(errors.largest_angle, 0.05);
}

TEST(RegisterPhotographs, WrongMatchesDoNotMatter) {
  MatchedSurvey survey = testing::matched_survey(strip(), {2, 7, 8, 9, 15, 20}, 25);
  const RegisterReport report =
      register_photographs(survey.bundle, survey.matches, with_scale_of(survey.truth, 0, 19));
  EXPECT_EQ(report.registered.size(), 6u);
  const auto errors = testing::pose_errors(survey.bundle, survey.truth, false);
  EXPECT_LT(errors.centre_rms, 0.001);
  EXPECT_LT(errors.largest_angle, 0.05);
}

// The pinhole engine made two models, of which one is read. No photograph is in both.
TEST(RegisterPhotographs, JoinsTheOtherHalf) {
  std::set<std::size_t> other;
  for (std::size_t i = 11; i < 21; ++i) other.insert(i);
  MatchedSurvey survey = testing::matched_survey(strip(), other, 5);
  const RegisterReport report =
      register_photographs(survey.bundle, survey.matches, with_scale_of(survey.truth, 0, 10));
  EXPECT_EQ(report.registered.size(), 10u);
  EXPECT_GT(report.added.points, 0u);
  const auto errors = testing::pose_errors(survey.bundle, survey.truth, false);
  EXPECT_LT(errors.centre_rms, 0.002);
  EXPECT_LT(errors.largest_angle, 0.1);
}

TEST(RegisterPhotographs, NamesThePhotographsThatStayOut) {
  const Bundle truth = strip();
  MatchedSurvey survey = testing::matched_survey(truth, {4, 6});
  // All matches of one photograph, and all but twenty of the other one are missing.
  FeatureMatches fewer(survey.matches.features());
  for (std::uint32_t i = 0; i < truth.images.size(); ++i) {
    int left = 20;
    for (const FeatureLink& link : survey.matches.links(i))
      if (i != 4 && link.other_image != 4 && link.other_image > i &&
          ((i != 6 && link.other_image != 6) || (i == 5 && left-- > 0)))
        fewer.add(i, link.feature, link.other_image, link.other_feature);
  }
  fewer.sort();
  const RegisterReport report =
      register_photographs(survey.bundle, fewer, with_scale_of(truth, 0, 19));
  EXPECT_TRUE(report.registered.empty());
  ASSERT_EQ(report.left_out.size(), 2u);
  EXPECT_EQ(report.left_out[0].image, 4u);
  EXPECT_EQ(report.left_out[0].reason, "0 matches with points, 30 are needed");
  EXPECT_EQ(report.left_out[1].image, 6u);
  EXPECT_THAT(report.left_out[1].reason, HasSubstr(" matches with points, 30 are needed"));
  EXPECT_EQ(observations_by_image(survey.bundle)[6], 0u);
}

TEST(RegisterPhotographs, TracksAreCompleted) {
  MatchedSurvey survey = testing::matched_survey(strip(), {});
  Bundle& bundle = survey.bundle;
  const std::size_t observations = bundle.observations.size(), points = bundle.points.size();
  // Every tenth observation and all observations of every seventh point are missing.
  std::size_t k = 0;
  std::erase_if(bundle.observations, [&](const Observation& observation) {
    return ++k % 10 == 0 || observation.point % 7 == 0;
  });
  const RegisterReport report =
      register_photographs(bundle, survey.matches, with_scale_of(survey.truth, 0, 19));
  EXPECT_EQ(bundle.points.size() - points, report.added.points);
  EXPECT_GT(report.added.points, points / 7 * 9 / 10);
  EXPECT_GT(bundle.observations.size(), observations * 98 / 100);
  EXPECT_LT(testing::pose_errors(bundle, survey.truth, false).centre_rms, 1e-12);
}

TEST(RegisterPhotographs, ResultDoesNotDependOnTheNumberOfThreads) {
  std::vector<Bundle> found;
  for (const unsigned threads : {1u, 3u}) {
    const ThreadLimit limit(threads);
    MatchedSurvey survey = testing::matched_survey(strip(), {2, 7, 8, 9, 15, 20}, 25);
    register_photographs(survey.bundle, survey.matches, with_scale_of(survey.truth, 0, 19));
    found.push_back(survey.bundle);
  }
  ASSERT_EQ(found[0].observations.size(), found[1].observations.size());
  for (std::size_t i = 0; i < found[0].observations.size(); ++i) {
    EXPECT_EQ(found[0].observations[i].point, found[1].observations[i].point);
    EXPECT_EQ(found[0].observations[i].source, found[1].observations[i].source);
  }
  for (std::size_t i = 0; i < found[0].images.size(); ++i) {
    EXPECT_EQ(found[0].images[i].pose.centre, found[1].images[i].pose.centre);
    EXPECT_EQ(found[0].images[i].pose.rotation, found[1].images[i].pose.rotation);
  }
}

}  // namespace
}  // namespace axial::pose
