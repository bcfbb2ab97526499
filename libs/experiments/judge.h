// SPDX-License-Identifier: GPL-3.0-or-later
// Measures the clouds and depth maps of a chain against the truth of their scene. All lengths are
// in metres.
#pragma once

#include <filesystem>
#include <string>

#include "experiments/chain.h"

namespace axial::experiments {

// Statistics of the true distances [m] along the rays of all pixels of all images of a medium.
struct SceneDistances {
  double median = 0;       // [m]
  double range_ratio = 0;  // 95th percentile / 5th percentile
};
// Precondition: the scene has images of `medium` ("air" or "water") with true distances.
SceneDistances scene_distances(const SimulatedScene& scene, const std::string& medium);

struct EvaluationOptions {
  double tolerance = 0.005;  // [m]
  // A place of the truth counts if at least `min_views` cameras under water see it. The default is
  // that of DensifyPointCloud's option --number-views-fuse.
  std::size_t min_views = 3;
  bool icp = false;              // aligns the cloud with the truth by a rigid motion first
  std::size_t samples = 200000;  // number of samples of the truth
  int picture_width = 0;         // [px]; 0: no picture
  double color_max = 0.010;      // error of the last colour in pictures [m]
  // What evaluated() does if the cloud has nothing to measure. true: it returns null. false: Error.
  bool or_nothing = false;
};
// Returns the options as inputs of a part (Part::inputs), except `icp` and `or_nothing`. These two
// options are no inputs, because a part measures with both values of the option, or always with the
// same value.
Json to_json(const EvaluationOptions& options);

// Measures the cloud in the folder `dense` with EvaluateReconstruction. The scene's cameras under
// water limit the measurement, also for clouds from images in air:
// - The statistics count the points that lie inside the images of at least `min_views` of these
//   cameras. Occlusion is not tested.
// - The completeness counts the surface that at least `min_views` of these cameras see.
// Fields of the result: "points", "mean", "median" and "variance" of the distances of the points to
// the truth [m, m^2]; "recall" and "f_score" at the tolerance; and, if `picture_width` is above 0,
// "picture" (PNG in base64). If there is nothing to measure, returns null with
// `options.or_nothing`, and otherwise throws an Error.
Json evaluated(const Chain& chain, const std::filesystem::path& dense, const SimulatedScene& scene,
               const EvaluationOptions& options);

// Measures all depth maps in the folder `dense` together. `medium`: the medium of the images of
// these maps. `tolerance`: [m]. An error is |estimate - truth| [m] of a pixel that has both. Fields
// of the result:
// - "pixels": number of errors
// - "gross": share of the errors that are gross (is_gross())
// - "mean": mean of the errors that are not gross
// - "median": median of all errors
// - "within": share of the errors that are at most the tolerance
// - "completeness": share of the pixels with a truth that also have an estimate
// - "rings": list of rings around the image centre (RelativeRing) with "inner", "outer", "count"
//   and "median", the median of (estimate - truth) / truth
// - "places": list of classes of pixels (ClassErrors) with "place" (a title), "truths", "pixels",
//   "gross" (a number of pixels), "mean" and "median"
// - "phases": list of phases (PhaseErrors) with "begin", "end", "count" and "shift"
// Error if a map, its truth or its photograph cannot be read, or as for evaluate_depth.
Json depth_errors(const std::filesystem::path& dense, const SimulatedScene& scene,
                  const std::string& medium, double tolerance);

// Returns EvaluateReconstruction's picture of depth, truth and error of the first depth map in
// `dense` (PNG in base64). `color_max`: error of the last colour [m]. `medium`: the medium of the
// images of the maps.
std::string depth_picture(const Chain& chain, const std::filesystem::path& dense,
                          const SimulatedScene& scene, const std::string& medium, double color_max);

// Returns the first photograph of the scene in `medium` (PNG in base64). A photograph wider than
// `width` pixels is reduced to this width.
std::string photograph(const SimulatedScene& scene, const std::string& medium, int width);

}  // namespace axial::experiments
