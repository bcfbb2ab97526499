// SPDX-License-Identifier: GPL-3.0-or-later
// Turns the poses that a pinhole engine found in underwater photographs into refractive poses.
#pragma once

#include <string>
#include <vector>

#include "pose/adjust/adjust.h"
#include "pose/adjust/position_sigma.h"
#include "pose/bundle/tracks.h"
#include "pose/control/target_points.h"

namespace axial::pose {

struct RefineOptions {
  AdjustOptions adjust;
  TrackLimits tracks;
  int rounds = 3;  // a round adjusts, then drops observations that do not fit (filter())
  // Targets whose points are in the bundle (add_targets()). Their observations are corrected after
  // each round (correct_targets()). Known lengths and places that do not fit are left out
  // (control_fit.h) if they have names.
  std::vector<Target> targets;
  // True: observations at the rim of photographs weigh less if their errors are larger
  // (weigh_by_radius() in observation_weights.h).
  bool weigh_by_radius = false;
  // True: free numbers whose measured values the observations do not contradict keep these values
  // (numbers_to_keep() in kept_numbers.h). The other numbers are adjusted once more.
  bool keep_stated = false;
};

// The report of refine(). "before": at the call, with the initial poses. "after": at the end, when
// the last observations have been dropped.
struct RefineReport {
  double rms_before = 0;  // RMS reprojection error of the refractive cameras [px]
  double rms_after = 0;   // the same error at the end [px]
  std::size_t observations_before = 0, observations_after = 0;
  std::size_t repeated = 0;  // dropped as repeated observations of a point in one image
  DropCounts dropped;        // dropped for other reasons
  std::size_t points_before = 0, points_after = 0;
  AdjustReport last;  // of the last adjustment
  // The lines of lost_knowledge() (known.h): the reasons why known lengths or positions can no
  // longer be used. refine() looks for them at the start and whenever it has dropped observations.
  // If it finds one before the last adjustment, it ends there, and `rms_after`,
  // `observations_after` and `points_after` stay 0.
  std::vector<std::string> lost;
  // The known positions that the last adjustment used, with the standard deviations that it used,
  // but stated standard deviations that are contradicted are corrected (correct_contradicted() in
  // position_sigma.h). uncertainty() needs these positions in place of `options.adjust.positions`.
  std::vector<KnownPosition> positions;
  PositionDistances position_distances;  // of these positions, before the correction
  // The known lengths and places that the last adjustment used. uncertainty() needs them in place
  // of those of `options.adjust`.
  std::vector<KnownDistance> distances;
  std::vector<KnownPlace> places;
  // A line for each bar, place or target that was left out, or that is doubtful.
  std::vector<std::string> wrong_control;
  // A line for each known position that was left out, because it does not fit the others
  // (judge_positions() in position_sigma.h).
  std::vector<std::string> wrong_positions;
};

// Scales a bundle of any scale to metres, as a first guess, and triangulates its points anew. A
// pinhole engine's model has no scale. The first rule that applies is used:
// - If `options.poses_known` is true, the poses are in metres and stay as they are.
// - Three or more `options.positions` place the bundle by a similarity.
// - `options.places` place the bundle (place_by_control() in control_start.h), and, if they do not
//   determine it, leave the scale to the next rules.
// - `options.distances` scale the bundle, by the median of their scales.
// - Stated poses of cameras in rigs scale the bundle (scale_by_rigs() in rig.h).
// - Otherwise a short adjustment is tried for a series of median scene distances from 0.25 to 16
//   m, and the scale with the smallest error is taken. The errors differ because refraction depends
//   on the distance in metres.
//
// The rigs of the bundle get their start (start_rigs()).
//
// Throws an Error if the rule of distances applies and a known distance is zero in the
// model or names a point that the bundle does not have. Throws an Error if the last rule applies
// and the bundle has no observations.
void bring_to_metres(Bundle& bundle, const AdjustOptions& options);

// Adjusts (adjust()) and filters (filter()) a bundle in metres for `options.rounds` rounds, then
// once more. The first round uses `options.adjust.pixel_sigma`, and four times the limits
// `options.adjust.loss_sigmas` and `options.tracks.max_error`. Later rounds use the limits
// themselves, and observed_pixel_sigma() of the round before. After
// each round, observations are weighed by the sizes of their features (weigh_by_size()). The first
// round also drops repeated observations (drop_repeated()). `context` gets a line for each
// round, and for an iteration of the solver if the last line is two seconds old (the lines of other
// iterations are details). With AdjustOptions::many_images or more poses, it also gets the start
// of each adjustment. The rounds before the last adjustment end at an AdjustOptions::least_gain and
// a gain_of_outliers of 0.1, or of `options.adjust` if that is larger: this is enough to find
// observations that do not fit. All adjustments after the first start close
// (AdjustOptions::starts_close).
//
// Known positions are judged (judge_positions() in position_sigma.h) at the start and after each
// round: positions that do not fit are left out, and the standard deviation of positions with
// `sigma_is_guess` is estimated. In the rounds, these positions have three times the estimate, so
// that the poses follow the observations and the estimate shows the accuracy of the positions. In
// the last adjustment they have the estimate itself.
//
// Photographs without observations leave the frames of rigs. Before the last round and the last
// adjustment, delays of cameras in rigs are found (set_delays() in rig.h), so that cameras that are
// not synchronised do not bend the model.
//
// For the standard deviations of the result, call uncertainty() with the refined bundle and
// `options.adjust`, but with the positions of the report. Throws an Error if no observation is
// left, or if adjust() fails.
RefineReport refine(Bundle& bundle, const RefineOptions& options, const Context& context = {});

// Multiplies the coordinates of all camera centres and points by `scale`.
void scale_places(Bundle& bundle, double scale);

}  // namespace axial::pose
