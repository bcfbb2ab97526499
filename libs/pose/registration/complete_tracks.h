// SPDX-License-Identifier: GPL-3.0-or-later
// Completes the tracks of a bundle from matches of features.
#pragma once

#include <vector>

#include "pose/bundle/tracks.h"
#include "pose/registration/feature_matches.h"

namespace axial::pose {

// What complete_tracks() added.
struct CompletedTracks {
  std::size_t observations = 0;  // of points that the bundle had
  std::size_t points = 0;        // new points
};

// The images whose features complete_tracks() uses. Both lists are by index of the image.
struct ImagesWithPoses {
  std::vector<bool> posed;  // true: the image has a pose
  // True: two observations are enough for a new point if one of them is in this image. Points of
  // other images need three, as in COLMAP.
  std::vector<bool> fresh;
  std::size_t last_source = 0;  // new points have values of BundlePoint::source above this
};

// Adds observations to points: a feature without a point that matches an observation of a point
// becomes an observation, if the image has no other observation of the point and the reprojection
// error is at most `limits.max_error`. This is repeated with the new observations. Then adds
// points: features without points that are connected by matches are triangulated, and become
// observations if their errors are at most `limits.max_error`, at most one in each image, and the
// widest angle between their rays is at least `limits.min_angle`. The position is that with most
// observations; features that are left over may make another point. New points have the next free
// values of BundlePoint::source. Rays and errors are those of the exact projection. The result does
// not depend on the number of threads.
CompletedTracks complete_tracks(Bundle& bundle, const FeatureMatches& matches,
                                const ImagesWithPoses& images, const TrackLimits& limits);

}  // namespace axial::pose
