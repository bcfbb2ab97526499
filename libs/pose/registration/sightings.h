// SPDX-License-Identifier: GPL-3.0-or-later
// The place of one photograph without a pose, among points that are known.
#pragma once

#include <string>

#include "pose/registration/absolute_pose.h"
#include "pose/registration/feature_matches.h"

namespace axial::pose {

// The points that the features of an image match. `points`: of all features
// (points_of_features()). Each feature and each point occurs at most once: a feature may match
// several points, and a point several features, of which the pair with most matches counts.
std::vector<Sighting> sightings_of(std::size_t image, const Bundle& bundle,
                                   const FeatureMatches& matches,
                                   const std::vector<std::vector<std::size_t>>& points);

// When sightings decide about a pose.
struct PlaceLimits {
  std::size_t least_sightings = 30;  // that agree with the pose
  double least_share = 0.25;         // of all sightings
  double most_of_second = 0.5;  // of the sightings that agree, so many may agree with another pose
  double most_angle = 0.5;      // standard deviation of the rotation [degrees]
  double most_centre = 0.02;    // standard deviation of the centre, divided by the distance
};

// The place of a photograph.
struct Place {
  Pose pose;
  std::string why_not;  // the reason, with numbers, why the pose is not used; empty: it is used
};

// The place of a photograph from its sightings. A pose is used if PlaceLimits allow it: if enough
// sightings agree with it, if the sightings that do not agree have no common other pose, and if the
// sightings determine it well. Repeated things, such as tiles, or matches in a small part of the
// photograph give no pose in this way.
Place place_of(const BundleCamera& camera, std::span<const Sighting> sightings,
               const AbsolutePoseOptions& options, const PlaceLimits& limits);

}  // namespace axial::pose
