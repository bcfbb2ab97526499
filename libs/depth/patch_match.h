// SPDX-License-Identifier: GPL-3.0-or-later
// PatchMatch multi-view stereo for axial cameras: computes the depth map of a reference view from
// its source views and some sparse points.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <stop_token>

#include "axial/depth.h"
#include "scene/camera_list.h"
#include "scene/depth_map.h"

namespace axial::depth {

// One view at the working resolution.
struct MatchImage {
  std::uint32_t id = 0;  // global id: key of the random numbers, entry of DepthMap::ids
  CameraModel camera;    // at the size of `grey`
  Pose pose;
  cv::Mat1b grey;  // grey levels 0 to 255, not empty
};

// The input of one call. Pointers that may be null have a comment that says so.
struct MatchInput {
  const MatchImage* reference = nullptr;
  std::span<const MatchImage* const> sources;      // 1 to 32, best first
  std::span<const Eigen::Vector3f> sparse_points;  // world frame, seen by the reference view
  const cv::Mat1b* mask = nullptr;                 // non-zero: match this pixel; null: all pixels
  ProjectionMethod projection = ProjectionMethod::exact;
  // If not null, this number is increased by the number of computed scores. A score is for one
  // plane in one view.
  std::uint64_t* scores = nullptr;
  // After a request to stop, estimate_depth_map() and refine_depth_map() throw Stopped. Matching
  // notices the request within a row of pixels.
  std::stop_token stop = {};
};

// Computes the photometric depth map of the reference view, first on the sub-resolution levels,
// then at the working resolution. The depth range is 0.9 times the smallest to 1.1 times the
// largest depth of the sparse points that are visible in the reference view. The mask is resized
// to the image if necessary. A pixel has no depth if the mask excludes it, if the distorted lens
// does not show it, if it is textureless and has no prior depth (options.min_texture), or if the
// cost of its best plane is options.keep_cost or more. The confidence is 1 - cost, or 0 if the
// cost is above 1. DepthMap::image_path stays empty. Throws an Error if
//   - no sparse point is visible in the reference view,
//   - there is no source view, or more than 32,
//   - the options ask for more than kMaxCandidates (candidates.h) planes of a pixel to be scored
//     together,
//   - the source images are too large for LaneMatcher (lane_matcher.h),
//   - the paper's homography (options.warp) or line search (input.projection) is asked for and does
//     not support the cameras: the homography needs lenses without distortion and not both flat and
//     dome ports, the line search needs lenses without distortion and no dome.
DepthMap estimate_depth_map(const MatchInput& input, const PatchMatchOptions& options);

// Returns an improved version of the depth map `current` of the reference view. Makes one sweep
// with the geometric-consistency term (eq. 7). Planes stay between the min_depth and max_depth of
// `current`. Pixels without a depth in `current` get none. `source_maps`: the depth maps of the
// source views, in the order of input.sources. A null or missing entry means that the view has no
// depth map. `pass`: the number of the pass, from 0, a key of the random numbers. `last`: true for
// the last pass. The last pass uses options.last_pairs pairs of trials, the other passes use
// options.later_pairs. Preconditions: `current` has the reference image's size, normals and
// confidences; each source map has the size of its image. Throws an Error as estimate_depth_map()
// does, except for sparse points, which are not used.
DepthMap refine_depth_map(const MatchInput& input, const DepthMap& current,
                          std::span<const DepthMap* const> source_maps, int pass, bool last,
                          const PatchMatchOptions& options);

// The sizes on which the memory of matching depends.
struct MatchSize {
  std::uint64_t pixels = 0;   // of the largest image of reference and sources
  std::uint64_t sources = 0;  // number of source views
};

// An upper bound of the memory [bytes] that estimate_depth_map() or refine_depth_map() needs.
// Includes the result and two copies of the result in which filters work, but not the input.
std::uint64_t bytes_needed(const MatchSize& size);

}  // namespace axial::depth
