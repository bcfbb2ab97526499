// SPDX-License-Identifier: GPL-3.0-or-later
// Turns the poses that a pinhole engine found in underwater photographs into refractive poses.
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
  int rounds = 3;  // a round adjusts, then drops observations that do not fit
};

struct RefineReport {
  double rms_before = 0;  // RMS reprojection error of refractive cameras at the initial poses [px]
  double rms_after = 0;   // after the last adjustment [px]
  std::size_t observations_before = 0, observations_after = 0;
  std::size_t repeated = 0;  // dropped as repeated observations of a point in one image
  DropCounts dropped;        // dropped for other reasons
  std::size_t points_before = 0, points_after = 0;
  AdjustReport last;  // of the last adjustment
  // The lines of lost_knowledge() (known.h): the reasons why known lengths or positions can no
  // longer be used. If there is a line before the last adjustment, refine() ends there, and
  // `rms_after`, `observations_after` and `points_after` stay 0.
  std::vector<std::string> lost;
};

// Scales a bundle of any scale to metres, as a first guess, and triangulates its points anew. A
// pinhole engine's model has no scale. The first rule that applies is used:
// - Known poses are in metres and stay as they are.
// - Three or more known positions place the bundle by a similarity.
// - The first known distance scales the bundle.
// - Otherwise a short adjustment is tried for a series of median scene distances from 0.25 to 16
//   m, and the scale with the smallest error is taken. The errors differ because refraction depends
//   on the distance in metres.
//
// Throws an Error if the first known distance is zero in the model, or if it names a point that the
// bundle does not have.
void bring_to_metres(Bundle& bundle, const AdjustOptions& options);

// Adjusts and filters a bundle in metres for `options.rounds` rounds, then once more. The first
// round uses `options.adjust.pixel_sigma`, and four times the limit `options.tracks.max_error`.
// Later rounds use observed_pixel_sigma() of the round before. `progress` gets one line for each
// round. For the standard deviations of the result, call uncertainty() with the refined bundle and
// `options.adjust`. Throws an Error if no observation is left.
RefineReport refine(Bundle& bundle, const RefineOptions& options,
                    const std::function<void(const std::string&)>& progress = {});

// Median distance [m] from the images to the points that they observe. Error if the bundle has no
// observations.
double median_distance(const Bundle& bundle);

// Multiplies all camera centres and points by `scale`.
void scale_places(Bundle& bundle, double scale);

}  // namespace axial::pose
