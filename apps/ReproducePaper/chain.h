// SPDX-License-Identifier: GPL-3.0-or-later
// The steps from a simulated scene to a measured cloud, each by a program of its own. Every step
// keeps its folder, and does nothing if the folder holds the result of the same step already.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/experiment.h"
#include "refractive/flat_port.h"

namespace axial {

using Words = std::vector<std::string>;
using experiments::Json;

struct Chain {
  std::filesystem::path work;  // where the steps keep their folders
  unsigned max_threads = 0;    // of each program; 0: all cores
};

// Fingerprints of all programs of the chain. They belong to the inputs of every result that is
// measured with the chain.
Json programs_of_the_chain();

// Options of SimulateUnderwater. The port is the preset's, except the values in `port`.
struct SceneOptions {
  std::string preset = "outcrop";
  int seed = 1, views = 10, width = 1024, height = 768, samples = 2;
  double fov_degrees = 80, scale = 1, relief = 1, coarseness = 1;
  std::string medium = "both";
  bool truth = true;  // distances; normals are removed
  Words port;         // "--tilt-degrees", "3"
  Words more;         // other options; they replace options above with the same name
};
Json to_json(const SceneOptions& options);

// A scene with ground truth: images in `folder`/air and `folder`/water. Later steps keep their
// folders in it, too.
struct SimulatedScene {
  std::filesystem::path folder;

  std::filesystem::path images(const std::string& medium) const { return folder / medium; }
  std::filesystem::path model() const { return folder / "sparse"; }
  std::filesystem::path mesh() const { return folder / "mesh.ply"; }
  std::filesystem::path housing() const { return folder / "housing.json"; }
};
SimulatedScene simulated(const Chain& chain, const SceneOptions& options);

// Distances along the rays of all pixels of a medium.
struct SceneDistances {
  double median = 0;       // [m]
  double range_ratio = 0;  // 95th over 5th percentile
};
SceneDistances scene_distances(const SimulatedScene& scene, const std::string& medium);

// The port that all underwater images of the scene are taken through.
refractive::FlatPort<double> port_of(const SimulatedScene& scene);

// The lens that COLMAP gets, and whether COLMAP refines it.
struct Calibration {
  std::string model = "PINHOLE";
  std::string parameters;  // "fx,fy,cx,cy,..."
  bool refine = false;     // otherwise the lens is fixed
};
Calibration true_lens(const SimulatedScene& scene);
// The start of a self-calibration under water: OPENCV without distortion, with the focal length of
// the lens in air times the water's index. COLMAP refines it.
Calibration self_calibration(const SimulatedScene& scene);
// The lens that COLMAP found in `colmap_model`, fixed.
Calibration calibration_of(const std::filesystem::path& colmap_model);

// Poses and sparse points from photographs, by the script axial-colmap-model. `model` is empty if
// COLMAP found poses for fewer than three images.
struct ColmapPoses {
  std::filesystem::path model;  // aligned with the true camera centres, in metres
  std::size_t images = 0;       // registered
  double centre_rms = 0;        // [m], RMS error of the aligned camera centres
};
ColmapPoses colmap_poses(const Chain& chain, const std::string& name, const SimulatedScene& scene,
                         const std::string& medium, const Calibration& calibration);

struct DenseOptions {
  std::filesystem::path housing;  // empty: no port is known
  Words more;                     // for DensifyPointCloud
  bool or_nothing = false;        // that nothing can be matched is a result, not an error
};
// The folder of a dense cloud and its depth maps; empty if nothing could be matched.
std::filesystem::path densified(const Chain& chain, const std::string& name,
                                const SimulatedScene& scene, const std::filesystem::path& model,
                                const std::string& medium, const DenseOptions& options);

// CPU time [s] of DensifyPointCloud when densified() made the folder `dense`.
double densify_seconds(const std::filesystem::path& dense);

// Fuses depth maps again that densified() made with the same `options`, with other options of
// DensifyPointCloud. `fusion` must not contain options of matching. Returns the cloud's folder,
// which lies in `dense`.
std::filesystem::path fused_again(const Chain& chain, const std::filesystem::path& dense,
                                  const std::string& name, const DenseOptions& options,
                                  const Words& fusion);

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
Json to_json(const EvaluationOptions& options);

// Distance statistics of a cloud in the field of view under water: points inside the images of at
// least `min_views` underwater cameras, for clouds of either medium. Also completeness of the
// surface that at least so many of these cameras see. Fields: "points", "mean", "median",
// "variance", "recall" and "f_score" at the tolerance, and "picture" (PNG in base64). Lengths in
// metres. Null if there is nothing to measure.
Json evaluated(const Chain& chain, const std::filesystem::path& dense, const SimulatedScene& scene,
               const EvaluationOptions& options);

// Errors of all depth maps of a folder together. Fields: "pixels"; "median" of |estimate - truth|
// [m]; "gross", the share of pixels with gross errors (is_gross()); "mean" of the other errors;
// "within", the share of pixels within the tolerance; "completeness", the share of pixels with a
// truth. "rings" around the image centre have "inner", "outer", "count" and the "median" of the
// signed error as a fraction of the true distance. "places" have "place", "truths", "pixels",
// "gross", "mean" and "median"; "phases" have "begin", "end", "count" and "shift" (depth_places.h).
Json depth_errors(const std::filesystem::path& dense, const SimulatedScene& scene,
                  const std::string& medium, double tolerance);

// EvaluateReconstruction's picture of the first view's depth, truth and error (PNG in base64).
std::string depth_picture(const Chain& chain, const std::filesystem::path& dense,
                          const SimulatedScene& scene, const std::string& medium, double color_max);

// The first photograph of the scene (PNG in base64).
std::string photograph(const SimulatedScene& scene, const std::string& medium, int width);

}  // namespace axial
