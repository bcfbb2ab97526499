// SPDX-License-Identifier: GPL-3.0-or-later
// Clean-up of finished depth maps (OPENMVS_FACTS 6.6). Pure functions: map in, map out (its images
// are new, what does not change is shared). An empty confidence counts as 1 everywhere.
#pragma once

#include <span>

#include "scene/depth_map.h"

namespace axial::depth {

struct SpeckleOptions {
  float max_difference = 0.007f;  // relative depth step within a segment
  int min_pixels = 100;           // smaller segments are cleared
};

// Clears 4-connected segments of similar depth that are too small.
DepthMap remove_speckles(const DepthMap& map, const SpeckleOptions& options = {});

struct GapOptions {
  int max_gap = 7;                // pixels
  float max_difference = 0.025f;  // relative, between the ends of the gap
};

// Fills short runs of invalid pixels, first along rows, then along columns: inverse depth linearly
// (a plane stays a plane), normals linearly and renormalised, confidence the lower of the two ends.
// Pixels with mask != 0 stay invalid (`mask` empty: none).
DepthMap fill_gaps(const DepthMap& map, const GapOptions& options = {},
                   const cv::Mat1b& mask = cv::Mat1b());

struct AdjustOptions {
  float max_difference = 0.012f;   // relative depth at which two maps agree
  int min_agreeing = 1;            // neighbours that must agree
  int min_seeing = 2;              // neighbours that must agree or disagree; capped by their number
  std::size_t max_neighbours = 8;  // the first ones count
};

// Splats each neighbour's points into the reference by exact projection, then replaces every depth
// by its confidence-weighted mean with the depths that agree, and its confidence by (agreement -
// contradiction). Clears pixels with less agreement than contradiction or outside [min_depth,
// max_depth] (where max_depth > 0). Depths are compared as lambda on the reference's own rays: a
// splat's tangent plane is met with the ray of each of the 4 pixels around its projection.
// Pass unfiltered neighbours and swap results in after all maps are done. Error for empty maps.
DepthMap adjust_with_neighbours(const DepthMap& reference, std::span<const DepthMap> neighbours,
                                const AdjustOptions& options = {});

}  // namespace axial::depth
