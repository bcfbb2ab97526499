// SPDX-License-Identifier: GPL-3.0-or-later
// PatchMatch multi-view stereo for axial cameras: computes the depth map of a reference view from
// its source views and some sparse points.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <span>

#include "depth/options.h"
#include "scene/camera_list.h"
#include "scene/depth_map.h"

namespace axial::depth {

// One view at the working resolution.
struct MatchImage {
  std::uint32_t id = 0;  // global id: key of the random numbers, entry of DepthMap::ids
  CameraModel camera;    // at the size of `grey`
  Pose pose;
  cv::Mat1b grey;
};

struct MatchInput {
  const MatchImage* reference = nullptr;
  std::span<const MatchImage* const> sources;      // 1 to 32, best first
  std::span<const Eigen::Vector3f> sparse_points;  // world frame, seen by the reference view
  const cv::Mat1b* mask = nullptr;                 // non-zero: match this pixel; null: all pixels
  ProjectionMethod projection = ProjectionMethod::exact;
  std::uint64_t* scores = nullptr;  // if given: increased by the number of planes scored, per view
};

// Computes the photometric depth map of the reference view: first on the sub-resolution levels,
// then at the working resolution. The depth range is the range of the visible sparse points, from
// 0.9 times the smallest to 1.1 times the largest depth. The mask is resized to the image if
// necessary. Confidence is 1 - cost, at least 0. Throws an Error if
//   - no sparse point is visible in the reference view,
//   - there is no source view, or more than 32,
//   - the options ask for more planes of a pixel at once than kMaxCandidates (candidates.h),
//   - the source images are too large for LaneMatcher,
//   - the paper's homography or line search is asked for and does not support the cameras.
DepthMap estimate_depth_map(const MatchInput& input, const PatchMatchOptions& options);

// Improves the depth map `current` of the reference view by one sweep with the
// geometric-consistency term (eq. 7). `source_maps`: the depth maps of the source views, in the
// order of input.sources; a null or missing entry means that the view has none. `pass` counts from
// 0. The `last` pass uses options.last_pairs trials. Precondition: `current` has the reference
// image's size, normals and confidences. Throws an Error as estimate_depth_map() does, except for
// sparse points, which are not used.
DepthMap refine_depth_map(const MatchInput& input, const DepthMap& current,
                          std::span<const DepthMap* const> source_maps, int pass, bool last,
                          const PatchMatchOptions& options);

// The sizes on which the memory of matching depends.
struct MatchSize {
  std::uint64_t pixels = 0;  // of the reference, and at most of each source
  std::uint64_t sources = 0;
};

// An upper bound of the memory [bytes] of estimate_depth_map() and refine_depth_map(), with their
// result and two copies of it in which filters work, without their input.
std::uint64_t bytes_needed(const MatchSize& size);

}  // namespace axial::depth
