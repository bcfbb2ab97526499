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
// Returns the statistics for the images of `medium` ("air" or "water"). Precondition: the scene has
// images of `medium` with true distances.
SceneDistances scene_distances(const SimulatedScene& scene, const std::string& medium);

// What evaluated() does.
struct EvaluationOptions {
  double tolerance = 0.005;  // of recall and F-score [m]
  // A place of the truth counts if at least `min_views` cameras under water see it. A point of the
  // cloud counts if it lies inside the images of at least `min_views` cameras under water. The
  // default is that of DensifyPointCloud's option --number-views-fuse.
  std::size_t min_views = 3;
  bool icp = false;  // true: aligns the cloud with the truth rigidly before measuring it
  std::size_t samples = 200000;  // wanted number of counted places of the truth
  int picture_width = 0;         // [px], of the picture of the cloud's errors; 0: no picture
  double color_max = 0.010;      // error of the last colour in this picture [m]
  // What evaluated() does if the cloud has nothing to measure. true: it returns null. false: Error.
  bool or_nothing = false;
};
// Returns the options as inputs of a part (Part::inputs), except `icp` and `or_nothing`. These two
// options need not be inputs, because each part measures with both values of the option, or always
// with one value.
Json to_json(const EvaluationOptions& options);

// Measures the cloud in the folder `dense` (a result of densified() or fused_again()) with
// EvaluateReconstruction. The scene's cameras under water limit the measurement. So clouds from
// images in air and from images under water are measured alike:
// - The statistics count the points that lie inside the images of at least `min_views` of these
//   cameras. Occlusion is not tested.
// - The completeness counts the surface that at least `min_views` of these cameras see.
// Fields of the result:
// - "points": number of points that count
// - "mean", "median" [m] and "variance" [m^2]: of the distances of these points to the truth
// - "recall" and "f_score": at the tolerance
// - "picture": the cloud in colours of its errors (PNG in base64); not if `picture_width` is 0
// If there is nothing to measure, returns null with `options.or_nothing`, and otherwise throws an
// Error.
Json evaluated(const Chain& chain, const std::filesystem::path& dense, const SimulatedScene& scene,
               const EvaluationOptions& options);

// Measures all depth maps in the folder `dense` (a result of densified()) together. `medium`: the
// medium of the images of these maps, "air" or "water". `tolerance`: [m]. An error is
// |estimate - truth| [m] of a pixel that has both. Fields of the result:
// - "pixels": number of errors
// - "gross": share of the errors that are gross (evaluate::is_gross())
// - "mean": mean of the errors that are not gross [m]
// - "median": median of all errors [m]
// - "within": share of the errors that are at most the tolerance
// - "completeness": share of the pixels with a truth that have an estimate
// - "rings": list of 8 rings from the image centre to the corners (evaluate::RelativeRing) with
//   "inner", "outer", "count" and "median", the median of (estimate - truth) / truth
// - "places": list of the 4 classes of pixels (evaluate::errors_by_class()) with "place" (a title),
//   "truths", "pixels", "gross" (a number of pixels), "mean" [m] and "median" [m]
// - "phases": list of 8 phases (evaluate::errors_by_phase()) with "begin", "end", "count" and
//   "shift" [px]
// Error if a map, its truth or its photograph cannot be read, or as for evaluate::evaluate_depth().
Json depth_errors(const std::filesystem::path& dense, const SimulatedScene& scene,
                  const std::string& medium, double tolerance);

// Returns EvaluateReconstruction's picture of depth, truth and error of the first depth map in the
// folder `dense`, in the order of file names (PNG in base64). A picture wider than 960 pixels is
// reduced to this width. `color_max`: error of the last colour [m]. `medium`: the medium of the
// images of the maps, "air" or "water". Precondition: there is a depth map with a truth.
std::string depth_picture(const Chain& chain, const std::filesystem::path& dense,
                          const SimulatedScene& scene, const std::string& medium, double color_max);

// Returns the first photograph of the scene in `medium` ("air" or "water"), in the order of file
// names (PNG in base64). A photograph wider than `width` pixels is reduced to this width.
// Precondition: the scene has photographs of `medium`.
std::string photograph(const SimulatedScene& scene, const std::string& medium, int width);

}  // namespace axial::experiments
