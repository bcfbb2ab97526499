// SPDX-License-Identifier: GPL-3.0-or-later
// Options of the matching stage. Lengths in pixels of the level that is worked on, angles in
// radians.
#pragma once

#include <numbers>

#include "depth/smoothness.h"

namespace axial::depth {

// How a patch is carried from the reference view into a source view.
enum class Warp {
  affine,     // the exact centre and the exact first derivative (DESIGN section 3)
  homography  // the paper's virtual-camera homography, eqs. (1)-(3), with rounded lookup
};

inline constexpr float radians(float degrees) {
  return degrees * std::numbers::pi_v<float> / 180.0f;
}

struct PatchMatchOptions {
  Warp warp = Warp::affine;
  int sub_resolution_levels = 1;  // coarser levels before the working resolution
  int iterations = 2;             // sweeps per level
  int coarsest_side = 64;         // no level gets a shorter side below this

  float sigma_color = 0.1f;  // bilateral weight: intensity, in [0, 1]
  float sigma_space = 3.0f;  // and distance [px]
  // Weighted sum of squared deviations below which a patch is textureless: a standard deviation of
  // half a grey level. OpenMVS's 4e-4, three times the deviation, gives up nearly three
  // quarters of sand whose texture is as strong as the camera's noise. Depths of weak texture that
  // the pixels around them do not confirm are removed afterwards (weak_texture.h).
  float min_texture = 3.6e-5f;

  SmoothnessOptions smoothness;

  // Texture, as for `min_texture`, at which the pull towards the coarser level's depth (in a
  // geometric pass: towards the depth so far) has fallen to 1/e. 0.002 is a standard deviation of 3
  // grey levels, two or three times a camera's noise. OpenMVS's 0.02 holds ground of low contrast,
  // too, to the coarser level's error (docs/performance.md, "Coarser levels").
  float prior_texture = 0.002f;

  // Pairs of trials on either side of a pixel's best plane. Few are enough where the plane is good
  // already; docs/performance.md counts what they cost, "How much there is to do".
  int first_pairs = 4;                   // in a level's first sweep
  int later_pairs = 2;                   // after it, also with geometric consistency
  int last_pairs = 0;                    // in the last geometric pass, which only propagates
  float refinement_shrink = 0.65f;       // of the ranges, from pair to pair
  int restart_trials = 3;                // random planes of a hopeless pixel
  float refinement_pixels = 2.0f;        // depth trial: largest motion in a source view
  float refinement_angle = radians(28);  // normal trial
  float good_cost = 0.594f, fair_cost = 0.81f, bad_cost = 0.99f;

  // Random planes across the ray, at most 5, that a pixel tries in a level's first sweep in place
  // of half the trials, if its best plane so far costs more than `certain_cost`. A thin structure
  // needs them: its pixels see the background at a fair cost, and a coarser level does not resolve
  // it.
  int search_planes = 4;
  float certain_cost = 0.15f;

  float keep_cost = 1.2f;  // hypotheses at or above are cleared

  float geometric_weight = 0.25f;
  float geometric_limit = 4.0f;
};

}  // namespace axial::depth
