// SPDX-License-Identifier: GPL-3.0-or-later
// The steps from a simulated scene to a measured cloud, each a program of its own. Every step keeps
// its folder and does nothing if it finds there what the same step made before.
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

// The bytes of all programs of the chain, in a few digits each. Belongs to the inputs of whatever
// is measured with it.
Json programs_of_the_chain();

// SimulateUnderwater's options; the port is the preset's unless given by `port`.
struct SceneOptions {
  std::string preset = "outcrop";
  int seed = 1, views = 10, width = 1024, height = 768, samples = 2;
  double fov_degrees = 80, scale = 1, relief = 1, coarseness = 1;
  std::string medium = "both";
  bool truth = true;  // distances; normals are thrown away
  Words port;         // "--tilt-degrees", "3"
  Words more;         // any others, before those above where they name the same
};
Json to_json(const SceneOptions& options);

// A scene with ground truth: images in `folder`/air and /water. Later steps keep theirs in it, too.
struct SimulatedScene {
  std::filesystem::path folder;

  std::filesystem::path images(const std::string& medium) const { return folder / medium; }
  std::filesystem::path model() const { return folder / "sparse"; }
  std::filesystem::path mesh() const { return folder / "mesh.ply"; }
  std::filesystem::path housing() const { return folder / "housing.json"; }
};
SimulatedScene simulated(const Chain& chain, const SceneOptions& options);

// Distances to what all pixels of a medium see.
struct SceneDistances {
  double median = 0;       // [m]
  double range_ratio = 0;  // 95th over 5th percentile
};
SceneDistances scene_distances(const SimulatedScene& scene, const std::string& medium);

// What all images of the scene under water look through.
refractive::FlatPort<double> port_of(const SimulatedScene& scene);

// How COLMAP comes by the lens.
struct Calibration {
  std::string model = "PINHOLE";
  std::string parameters;  // "fx,fy,cx,cy,..."
  bool refine = false;     // else as given
};
Calibration true_lens(const SimulatedScene& scene);
// OPENCV, from what one knows beforehand: the lens in air, its focal length times the water's
// index.
Calibration self_calibration(const SimulatedScene& scene);
Calibration calibration_of(const std::filesystem::path& colmap_model);  // as found, kept

// Poses and sparse points from photographs. `model` is empty where COLMAP found none.
struct ColmapPoses {
  std::filesystem::path model;  // brought to metres by the true camera centres
  std::size_t images = 0;       // registered
  double centre_rms = 0;        // of their centres, after that [m]
};
ColmapPoses colmap_poses(const Chain& chain, const std::string& name, const SimulatedScene& scene,
                         const std::string& medium, const Calibration& calibration);

struct DenseOptions {
  std::filesystem::path housing;  // empty: no port is known
  Words more;                     // for DensifyPointCloud
  bool or_nothing = false;        // nothing to match is a result, and no error
};
// The folder of a dense cloud and its depth maps; empty where there was nothing to match.
std::filesystem::path densified(const Chain& chain, const std::string& name,
                                const SimulatedScene& scene, const std::filesystem::path& model,
                                const std::string& medium, const DenseOptions& options);

// CPU time of DensifyPointCloud in densified(), its `dense`, whenever that was [s].
double densify_seconds(const std::filesystem::path& dense);

// Depth maps that densified() made with the same `options`, fused again with other options of
// DensifyPointCloud, none of which may concern matching; the cloud's folder, within theirs.
std::filesystem::path fused_again(const Chain& chain, const std::filesystem::path& dense,
                                  const std::string& name, const DenseOptions& options,
                                  const Words& fusion);

struct EvaluationOptions {
  double tolerance = 0.005;  // [m]
  // Cameras under water that must see a place for it to count: as many as fusion asks for
  // (--number-views-fuse).
  std::size_t min_views = 3;
  bool icp = false;
  std::size_t samples = 200000;
  int picture_width = 0;     // 0: no picture
  double color_max = 0.010;  // error of the pictures' last colour [m]
  bool or_nothing = false;   // a cloud that leaves nothing to measure is a result, and no error
};
Json to_json(const EvaluationOptions& options);

// Distance statistics of a cloud within the field of view under water (points in the images of at
// least `min_views` cameras there), whatever medium it is from, and completeness of what so many of
// these cameras see: "points", "mean", "median", "variance", "recall" and "f_score" at the
// tolerance, and "picture" (PNG in base64). Lengths in metres. Null: nothing to measure.
Json evaluated(const Chain& chain, const std::filesystem::path& dense, const SimulatedScene& scene,
               const EvaluationOptions& options);

// Errors of all depth maps of a folder, as one: "pixels", "median" of |estimate - truth| [m],
// "gross": share of the pixels that is_gross() is true of, "mean" of the others, "within": share
// of these pixels at the tolerance, "completeness": share of the pixels with a truth. "rings"
// around the image centre, each with "inner", "outer", "count" and the "median" of the signed error
// as a fraction of the true distance. "places" (by "place", with "truths", "pixels", "gross",
// "mean", "median") and "phases" ("begin", "end", "count", "shift"): depth_places.h.
Json depth_errors(const std::filesystem::path& dense, const SimulatedScene& scene,
                  const std::string& medium, double tolerance);

// EvaluateReconstruction's picture of the first view's depth, truth and error (PNG in base64).
std::string depth_picture(const Chain& chain, const std::filesystem::path& dense,
                          const SimulatedScene& scene, const std::string& medium, double color_max);

// The first view as it was taken (PNG in base64).
std::string photograph(const SimulatedScene& scene, const std::string& medium, int width);

}  // namespace axial
