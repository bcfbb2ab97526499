// SPDX-License-Identifier: GPL-3.0-or-later
// The steps from a simulated scene to a dense cloud, each by a program of its own. Every step keeps
// its folder, and does nothing if the folder holds the result of the same step already. judge.h
// measures the results.
//
// The programs lie beside the running program. Their output goes to a log in the step's folder. If
// a program fails, the step throws an Error that names the program and its log, and is repeated
// when it is asked for again.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/experiment.h"
#include "refractive/flat_port.h"

namespace axial::experiments {

using Words = std::vector<std::string>;  // of a command line

struct Chain {
  std::filesystem::path work;  // where the steps keep their folders
  unsigned max_threads = 0;    // of each program; 0: all cores
};

// Fingerprints of all programs of the chain. They belong to the inputs of every result that is
// measured with the chain. Error if a program does not lie beside the running program.
Json programs_of_the_chain();

// Options of SimulateUnderwater. The port is the preset's, except the values in `port`.
struct SceneOptions {
  std::string preset = "outcrop";
  int seed = 1, views = 10, width = 1024, height = 768;  // images of width x height pixels
  int samples = 2;                                       // rays along each side of a pixel
  double fov_degrees = 80, scale = 1, relief = 1, coarseness = 1;
  std::string medium = "both";  // "air", "water" or "both"
  bool truth = true;            // distances; normals are removed
  Words port;                   // "--tilt-degrees", "3"
  Words more;                   // other options; they replace options above with the same name
};
// The options as the words of SimulateUnderwater's command line, without the output folder.
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

// The scene of these options, in a folder of `chain.work` whose name depends on the options.
SimulatedScene simulated(const Chain& chain, const SceneOptions& options);

// The port that all underwater images of the scene are taken through. Precondition: it is flat.
refractive::FlatPort<double> port_of(const SimulatedScene& scene);

// The lens that COLMAP gets, and whether COLMAP refines it.
struct Calibration {
  std::string model = "PINHOLE";
  std::string parameters;  // "fx,fy,cx,cy,..." [px], in COLMAP's pixel convention
  bool refine = false;     // otherwise the lens is fixed
};
// The lens of the scene in air, fixed.
Calibration true_lens(const SimulatedScene& scene);
// The start of a self-calibration under water: OPENCV without distortion, with the focal length of
// the lens in air times the water's index. COLMAP refines it. Precondition: the scene's lens is a
// pinhole.
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
// COLMAP's poses for the photographs of `medium`, in the folder `name` of the scene. COLMAP runs
// again only if its own inputs change, because its poses are not reproducible.
ColmapPoses colmap_poses(const Chain& chain, const std::string& name, const SimulatedScene& scene,
                         const std::string& medium, const Calibration& calibration);

struct DenseOptions {
  std::filesystem::path housing;  // empty: no port is known
  Words more;                     // for DensifyPointCloud
  bool or_nothing = false;        // that nothing can be matched is a result, not an error
};
// The folder of a dense cloud and its depth maps, in the folder `name` of the scene: from the
// photographs of `medium` and the poses of the COLMAP model `model`. Empty if nothing could be
// matched.
std::filesystem::path densified(const Chain& chain, const std::string& name,
                                const SimulatedScene& scene, const std::filesystem::path& model,
                                const std::string& medium, const DenseOptions& options);

// CPU time [s] of DensifyPointCloud when densified() made the folder `dense`. Error that names the
// file if the time cannot be read.
double densify_seconds(const std::filesystem::path& dense);

// Fuses depth maps again that densified() made with the same `options`, with other options of
// DensifyPointCloud. `fusion` must not contain options of matching. Returns the cloud's folder,
// which lies in `dense`.
std::filesystem::path fused_again(const Chain& chain, const std::filesystem::path& dense,
                                  const std::string& name, const DenseOptions& options,
                                  const Words& fusion);

}  // namespace axial::experiments
