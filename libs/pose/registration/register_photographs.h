// SPDX-License-Identifier: GPL-3.0-or-later
// Gives poses to photographs that a pinhole engine left out: by their matches with known points, as
// the photographs show them through their ports.
#pragma once

#include <string>
#include <vector>

#include "pose/refine.h"
#include "pose/registration/complete_tracks.h"
#include "pose/registration/sightings.h"

namespace axial::pose {

struct RegisterOptions {
  AdjustOptions adjust;  // `points_known` and `poses_known` are false
  TrackLimits tracks;    // `min_observations` is PlaceLimits::least_sightings, too
  PlaceLimits place;
  int attempts = 3;  // poses that adjustment does not confirm, before a photograph is given up
  // New points have values of BundlePoint::source above this and above those of the bundle.
  std::size_t last_source = 0;
};

// A photograph without a pose.
struct LeftOut {
  std::size_t image = 0;  // index into Bundle::images
  std::string reason;     // with numbers, for example "12 matches with points, 30 are needed"
};

struct RegisterReport {
  // Images that had no observations. Both lists are in the order of Bundle::images.
  std::vector<std::size_t> registered;
  std::vector<LeftOut> left_out;
  CompletedTracks added;  // before filter()
};

// Gives poses to images of `bundle` without observations, whose poses are not used, and completes
// the tracks. All images whose features match enough points get a pose (place_of()). Then the
// tracks are completed (complete_tracks()), so that further images match points. When the number of
// images has grown by a tenth, or when no further image can get a pose, the bundle is adjusted
// (adjust()), and observations that do not fit are dropped (filter()). This is repeated until no
// image is added. Groups of images that share no point with the others join the bundle in this way,
// one image after the other. Images that filter() drops can get another pose.
//
// The result does not depend on the number of threads. `context` gets a line after each
// adjustment. Precondition: the bundle is in metres and refined (refine()), and has observations.
// Throws the errors of adjust().
RegisterReport register_photographs(Bundle& bundle, const FeatureMatches& matches,
                                    const RegisterOptions& options, const Context& context = {});

}  // namespace axial::pose
