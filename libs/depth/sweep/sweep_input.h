// SPDX-License-Identifier: GPL-3.0-or-later
// What a sweep (sweep.h) knows besides the views and the plane map.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <stop_token>

#include "base/context.h"

namespace axial::depth {

// Throws Stopped after a request to stop.
inline void check_stop(const std::stop_token& stop) {
  if (stop.stop_requested()) throw Stopped();
}

// The images of all pointers have the size of the plane map, and must outlive the sweep.
struct SweepInput {
  std::uint32_t image_id = 0;  // global id of the reference image: a key of the random numbers
  std::uint32_t sweep = 0;     // unique over levels and passes; odd sweeps run backwards
  // Range of depths [m], above 0. A plane at another depth counts as no hypothesis.
  float min_depth = 0;
  float max_depth = 0;
  // Prior depths from the coarser level [m]; 0: this pixel has no prior; null: no pixel has a
  // prior.
  const cv::Mat1f* prior = nullptr;
  // Prior depths [m] that replace `prior` at textureless pixels; 0: this pixel has no prior; null:
  // `prior` counts at textureless pixels, too. A textureless pixel without a prior loses its
  // hypothesis. A geometric pass sets this field to the current depths: so textureless pixels,
  // which have their depths from the coarser levels, do not lose these depths.
  const cv::Mat1f* textureless_prior = nullptr;
  // Non-zero: visit this pixel. Zero: the pixel loses its hypothesis. Null: visit all pixels.
  const cv::Mat1b* mask = nullptr;
  int trial_pairs = 0;  // pairs of trials around the best hypothesis, at most 4
  // True in the first sweep of a level: a pixel without a hypothesis gets a random plane, and a
  // pixel whose plane is not certain tries random planes. False: neither happens.
  bool first = false;
  // True: the pixel's own plane and the planes of its neighbours are scored in up to kManyViews
  // views.
  bool many_views = false;
  std::stop_token stop = {};  // a sweep throws Stopped within a row of pixels after a request
};

}  // namespace axial::depth
