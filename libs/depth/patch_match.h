// SPDX-License-Identifier: GPL-3.0-or-later
// PatchMatch multi-view stereo for axial cameras: one depth map out of a reference view, its source
// views and a few sparse points.
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
  std::uint32_t id = 0;  // global id: keys the random numbers and names the view in DepthMap::ids
  CameraModel camera;
  Pose pose;
  cv::Mat1b grey;
};

struct MatchInput {
  const MatchImage* reference = nullptr;
  std::span<const MatchImage* const> sources;      // 1 to 32, best first
  std::span<const Eigen::Vector3f> sparse_points;  // world frame, seen by the reference view
  const cv::Mat1b* mask = nullptr;                 // non-zero: match this pixel; null: all
  ProjectionMethod projection = ProjectionMethod::exact;
  std::uint64_t* scores = nullptr;  // if given: counted up by every plane scored in a view
};

// Photometric depth map: sub-resolution levels, then the working resolution. The depth range is
// that of the sparse points, widened by 10 %. Error if no sparse point is visible or there is no
// source.
DepthMap estimate_depth_map(const MatchInput& input, const PatchMatchOptions& options);

// One sweep with the geometric-consistency term (eq. 7) from the source views' own depth maps, in
// the order of input.sources (null: none). `pass` counts from 0; the `last` applies the final
// threshold.
DepthMap refine_depth_map(const MatchInput& input, const DepthMap& current,
                          std::span<const DepthMap* const> source_maps, int pass, bool last,
                          const PatchMatchOptions& options);

}  // namespace axial::depth
