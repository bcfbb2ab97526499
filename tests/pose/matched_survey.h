// SPDX-License-Identifier: GPL-3.0-or-later
// A survey with the features and matches of its photographs, some of which have no pose.
#pragma once

#include <set>

#include "pose/registration/feature_matches.h"
#include "pose/survey.h"

namespace axial::pose::testing {

struct MatchedSurvey {
  Bundle truth;   // all images, points and observations
  Bundle bundle;  // the truth without the observations of the images that are left out
  FeatureMatches matches{{}};
};

// Returns a survey in which the images `left_out` have neither observations nor poses, and points
// that fewer than two other images observe are missing. Features of one point match in all pairs
// of images. `wrong` further matches of each pair are at random.
MatchedSurvey matched_survey(const Bundle& truth, const std::set<std::size_t>& left_out,
                             int wrong = 0);

// Removes the images `left_out` from the bundle, as matched_survey() does.
void leave_out(Bundle& bundle, const std::set<std::size_t>& left_out);

}  // namespace axial::pose::testing
