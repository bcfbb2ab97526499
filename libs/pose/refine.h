// SPDX-License-Identifier: GPL-3.0-or-later
// From poses that a pinhole engine found in photographs taken under water to refractive ones.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pose/adjust.h"
#include "pose/tracks.h"

namespace axial::pose {

struct RefineOptions {
  AdjustOptions adjust;
  TrackLimits tracks;
  int rounds = 3;  // of adjusting and dropping what does not fit
  // After each round's adjustment: may move the bundle's observations, as place_again() does.
  std::function<void()> between_rounds;
};

struct RefineReport {
  double rms_before = 0;  // [px], refractive cameras at the poses it began with
  double rms_after = 0;
  std::size_t observations_before = 0, observations_after = 0;
  std::size_t repeated = 0;  // of the former: further ones of an image that sees the point already
  DropCounts dropped;        // the others that are not left
  std::size_t points_before = 0, points_after = 0;
  AdjustReport last;
  // Not empty: refining ended early, because what is known in metres has lost its hold on the
  // bundle; the lines of lost_knowledge().
  std::vector<std::string> lost;
};

// Brings a bundle of any scale to metres, a first guess, and triangulates it anew: a pinhole
// engine's model has no scale (known poses have it, and stay as they are). What is known in metres
// sets it; else that scale out of a series is taken under which a short adjustment leaves the least
// error, since refraction depends on the distance in metres.
void bring_to_metres(Bundle& bundle, const AdjustOptions& options);

// Rounds of adjusting and filtering a bundle in metres, the later ones with the noise that was
// found as the observations' weight. How well the result is known, uncertainty() of the bundle and
// `options.adjust` tells. Error for a bundle of which nothing is left.
RefineReport refine(Bundle& bundle, const RefineOptions& options,
                    const std::function<void(const std::string&)>& progress = {});

// Median distance [m] of the points from the images that observe them.
double median_distance(const Bundle& bundle);

// All places multiplied by `scale`.
void scale_places(Bundle& bundle, double scale);

}  // namespace axial::pose
