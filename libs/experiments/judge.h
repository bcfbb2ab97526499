// SPDX-License-Identifier: GPL-3.0-or-later
// Measures the clouds and depth maps of a chain against the truth of their scene. All lengths in
// metres.
#pragma once

#include <filesystem>
#include <string>

#include "experiments/chain.h"

namespace axial::experiments {

// Distances along the rays of all pixels of a medium.
struct SceneDistances {
  double median = 0;       // [m]
  double range_ratio = 0;  // 95th over 5th percentile
};
// Precondition: the scene has images of `medium` with a truth.
SceneDistances scene_distances(const SimulatedScene& scene, const std::string& medium);

struct EvaluationOptions {
  double tolerance = 0.005;  // [m]
  // A place counts if at least so many cameras under water see it. The default is the default of
  // --number-views-fuse.
  std::size_t min_views = 3;
  bool icp = false;
  std::size_t samples = 200000;
  int picture_width = 0;     // 0: no picture
  double color_max = 0.010;  // [m], error of the last colour in pictures
  bool or_nothing = false;   // a cloud with nothing to measure is a result, not an error
};
// The options as inputs of a part (Part::inputs). Without `icp` and `or_nothing`: a part measures
// with both values of such an option, or always with the same value.
Json to_json(const EvaluationOptions& options);

// Distance statistics of the cloud of the folder `dense`, and its completeness. Both are limited to
// the field of view under water, for clouds from images in either medium: the statistics to points
// inside the images of at least `min_views` underwater cameras, the completeness to the surface
// that at least `min_views` of these cameras see. Fields: "points", "mean", "median", "variance",
// "recall" and "f_score" at the tolerance, and "picture" (PNG in base64). Lengths in metres. Null
// if there is nothing to measure.
Json evaluated(const Chain& chain, const std::filesystem::path& dense, const SimulatedScene& scene,
               const EvaluationOptions& options);

// Errors of all depth maps of a folder together. Fields: "pixels"; "median" of |estimate - truth|
// [m]; "gross", the share of pixels with gross errors (is_gross()); "mean" of the other errors;
// "within", the share of pixels within the tolerance; "completeness", the share of the pixels with
// a truth that also have an estimate. "rings" around the image centre have "inner", "outer",
// "count" and the "median" of the signed error as a fraction of the true distance. "places" have
// "place", "truths", "pixels", "gross", "mean" and "median"; "phases" have "begin", "end", "count"
// and "shift" (pixel_classes.h). Error if a map, its truth or its photograph cannot be read.
Json depth_errors(const std::filesystem::path& dense, const SimulatedScene& scene,
                  const std::string& medium, double tolerance);

// EvaluateReconstruction's picture of the first view's depth, truth and error (PNG in base64).
// `color_max`: error of the last colour [m].
std::string depth_picture(const Chain& chain, const std::filesystem::path& dense,
                          const SimulatedScene& scene, const std::string& medium, double color_max);

// The first photograph of the scene (PNG in base64), reduced to `width` pixels.
std::string photograph(const SimulatedScene& scene, const std::string& medium, int width);

}  // namespace axial::experiments
