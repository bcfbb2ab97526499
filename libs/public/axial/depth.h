// SPDX-License-Identifier: GPL-3.0-or-later
// Options of matching, and of the filters for finished depth maps. Lengths are in pixels of the
// resolution level that is matched, angles in radians. A level is the reference image with its
// source images, all halved equally often. The last level has the working resolution, and each
// coarser level has half the width and height of the next finer level.
#pragma once

#include <numbers>

namespace axial::depth {

// How the matching window is mapped from the reference view to a source view.
enum class Warp {
  affine,     // exact projection of the centre, exact first derivative (docs/refraction.md)
  homography  // the paper's homography between virtual cameras (eqs. 1-3) of rounded pixels
};

inline constexpr float radians(float degrees) {
  return degrees * std::numbers::pi_v<float> / 180.0f;
}

// The smoothness factor of a hypothesis (the paper's eq. 6). d_v is the distance of a neighbour's
// point from the plane through the point X of the hypothesis.
struct SmoothnessOptions {
  float depth_sigma = 0.02f;  // standard deviation of d_v / |X|
  float depth_bonus = 0.07f;  // largest reduction of the factor by d_v of one neighbour
  // Standard deviation of the angle between the normals of hypothesis and neighbour [rad].
  float normal_sigma = 13 * std::numbers::pi_v<float> / 180;
  float normal_bonus = 0.0672f;  // largest reduction of the factor by one neighbour's normal
};

struct PatchMatchOptions {
  Warp warp = Warp::affine;
  int sub_resolution_levels = 1;  // largest number of coarser levels, 0 or more
  int iterations = 2;             // sweeps per level, 1 or more
  // A coarser level is used only if the shorter side of its reference image is at least this [px].
  int coarsest_side = 64;

  // Standard deviations of the bilateral weights of texels: by the difference of intensities (0 to
  // 1) from the patch's centre, and by the distance from the centre [px].
  float sigma_color = 0.1f;
  float sigma_space = 3.0f;
  // A patch is textureless if its ReferencePatch::texture is below this value. A pixel with a
  // textureless patch gets no depth, unless it has a prior depth (prior_texture). The value
  // corresponds to a standard deviation of half a grey level. OpenMVS's value of 4e-4 corresponds
  // to three times this deviation. With OpenMVS's value, nearly three quarters of the pixels are
  // lost on sand whose texture is as strong as the camera's noise. Depths of weak texture that the
  // pixels around them do not confirm are removed later.
  float min_texture = 3.6e-5f;

  SmoothnessOptions smoothness;

  // The cost of a plane is blended with the difference between the plane's depth and a prior
  // depth. Usually, the prior is the depth of the coarser level.
  // In a geometric pass, the prior is the current depth, and only textureless pixels have a
  // prior. The prior's weight is exp(-texture / prior_texture). The value 0.002 corresponds to a
  // standard deviation of 3 grey levels, which is two or three times a camera's noise. With
  // OpenMVS's value of 0.02, ground of low contrast takes over the errors of the coarser level
  // (docs/performance.md, "Coarser levels").
  float prior_texture = 0.002f;

  // Trials are planes near a pixel's best plane. Trials come in pairs, with one trial on either
  // side of the best plane. More than 4 pairs are an error. If the best plane is good already, few
  // trials are enough. docs/performance.md, "How much there is to do", gives their number and cost.
  int coarse_pairs = 4;             // in the first sweep of a coarser level
  int first_pairs = 2;              // in the first sweep of the working resolution
  int later_pairs = 2;              // in later sweeps and geometric passes except the last
  int last_pairs = 0;               // in the last geometric pass, which only propagates
  float refinement_shrink = 0.65f;  // factor of the ranges from one pair to the next
  // Number of random planes for a pixel whose cost is bad_cost or more. More than 8 are an error.
  int restart_trials = 3;
  // Range of depth trials: the motion of the surface point's image in the best source view. The
  // range is at most 5 % of the depth, and 0.3 % of the depth if this motion is not known.
  float refinement_pixels = 2.0f;
  float refinement_angle = radians(28);  // range of normal trials [rad]
  // The cost of a pixel's best plane scales the ranges of trials: by 1/4 if the cost is at most
  // good_cost, otherwise by 1/2 if it is at most fair_cost, otherwise by 1. If the cost is
  // bad_cost or more, the pixel tries restart_trials random planes first.
  float good_cost = 0.594f, fair_cost = 0.81f, bad_cost = 0.99f;

  // In a level's first sweep, a pixel tries `search_planes` random planes perpendicular to the
  // ray if its best plane so far costs more than `certain_cost`. Such a pixel tries
  // `search_pairs` pairs of trials in place of coarse_pairs or first_pairs. With 0 search planes
  // there is no search. More than 5 search planes are an error. Thin structures need the random
  // planes: their pixels match the background at a fair cost, and the coarser level does not
  // resolve them.
  int search_planes = 4;
  int search_pairs = 2;
  float certain_cost = 0.15f;

  float keep_cost = 1.2f;  // hypotheses with this cost or more neither spread nor become depths

  float geometric_weight = 0.25f;  // of the geometric-consistency term (eq. 7) in the cost
  float geometric_limit = 4.0f;    // largest value of this term before it is weighted
};

// The removal of small segments.
struct SpeckleOptions {
  float max_difference = 0.007f;  // relative depth step below which neighbours are connected
  int min_pixels = 100;           // segments with fewer pixels are cleared
};

// The filling of small gaps.
struct GapOptions {
  int max_gap = 7;                // longest gap that is filled [px]
  float max_difference = 0.025f;  // limit of the relative depth step over the gap
};

}  // namespace axial::depth
