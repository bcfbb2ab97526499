// SPDX-License-Identifier: GPL-3.0-or-later
// The steps from a simulated scene to a dense cloud. Each step runs programs of the project and
// keeps its results in a folder of its own. A step does nothing if its folder already holds the
// result of the same inputs. judge.h measures the results.
//
// The programs lie beside the running program. Their output goes to a log in the step's folder. If
// a program fails, the step throws an Error that names the program and its log. The next call of a
// failed step repeats the step.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/experiment.h"
#include "refractive/flat_port.h"

namespace axial::experiments {

using Words = std::vector<std::string>;  // words of a command line

struct Chain {
  std::filesystem::path work;  // the folder that contains the folders of the steps
  unsigned max_threads = 0;    // number of threads of each program; 0: all cores
};

// Returns the fingerprints of all programs of the chain. If a part (experiment.h) uses the chain,
// Part::inputs must contain these fingerprints. Error if a program does not lie beside the running
// program.
Json programs_of_the_chain();

// Options of SimulateUnderwater. The options of the port in `port` replace those of the preset.
struct SceneOptions {
  std::string preset = "outcrop";
  int seed = 1, views = 10, width = 1024, height = 768;  // images of width x height pixels
  int samples = 2;                                       // rays along each side of a pixel
  double fov_degrees = 80, scale = 1, relief = 1, coarseness = 1;
  std::string medium = "both";  // "air", "water" or "both"
  bool truth = true;            // keep true distances; true normals are always removed
  Words port;                   // options of the port: "--tilt-degrees", "3"
  Words more;                   // more options; they take precedence over numbers and `truth`
};
// Returns the words of SimulateUnderwater's command line, without the output folder.
Json to_json(const SceneOptions& options);

// A scene with ground truth. Its images are in `folder`/air and `folder`/water. Later steps keep
// their folders in `folder`, too.
struct SimulatedScene {
  std::filesystem::path folder;

  std::filesystem::path images(const std::string& medium) const { return folder / medium; }
  std::filesystem::path model() const { return folder / "sparse"; }
  std::filesystem::path mesh() const { return folder / "mesh.ply"; }
  std::filesystem::path housing() const { return folder / "housing.json"; }
};

// Simulates the scene of these options. The folder of the scene lies in `chain.work`. The name of
// the folder depends on the options.
SimulatedScene simulated(const Chain& chain, const SceneOptions& options);

// Returns the port through which all underwater images of the scene are taken. Precondition: the
// port is flat.
refractive::FlatPort<double> port_of(const SimulatedScene& scene);

// The lens that COLMAP gets, and whether COLMAP refines it.
struct Calibration {
  std::string model = "PINHOLE";
  std::string parameters;  // "fx,fy,cx,cy,..." [px], in COLMAP's pixel convention
  bool refine = false;     // true: COLMAP refines the lens; false: the lens is fixed
};
// Returns the lens of the scene in air. COLMAP does not refine the lens.
Calibration true_lens(const SimulatedScene& scene);
// Returns the initial lens of a self-calibration under water. The model is OPENCV without
// distortion. The focal lengths are the focal lengths in air times the refractive index of the
// water. COLMAP refines the lens. Preconditions: the lens of the scene is a pinhole (model PINHOLE)
// and the port is flat.
Calibration self_calibration(const SimulatedScene& scene);
// Returns the lens of the first camera in `colmap_model`. COLMAP does not refine the lens.
Calibration calibration_of(const std::filesystem::path& colmap_model);

// Poses and sparse points from photographs, by the script axial-colmap-model. `model` is empty if
// COLMAP found poses for fewer than three images.
struct ColmapPoses {
  std::filesystem::path model;  // aligned with the true camera centres, in metres
  std::size_t images = 0;       // number of images for which COLMAP found poses
  double centre_rms = 0;        // [m], RMS error of the aligned camera centres
};
// Computes poses for the photographs of `medium` ("air" or "water") with COLMAP. The results lie in
// the folder `name` of the scene. COLMAP's poses are not reproducible, so COLMAP runs again only if
// the medium or the calibration changes.
ColmapPoses colmap_poses(const Chain& chain, const std::string& name, const SimulatedScene& scene,
                         const std::string& medium, const Calibration& calibration);

struct DenseOptions {
  std::filesystem::path housing;  // empty: no port is known
  Words more;                     // more options of DensifyPointCloud
  // What densified() does if no image can be matched. true: it returns an empty path. false: Error.
  bool or_nothing = false;
};
// Computes depth maps and a dense cloud from the photographs of `medium` ("air" or "water") and the
// poses of the COLMAP model `model`. Returns the folder of the depth maps and the cloud, which is
// the folder `name` of the scene. With `options.or_nothing`, returns an empty path if no image can
// be matched.
std::filesystem::path densified(const Chain& chain, const std::string& name,
                                const SimulatedScene& scene, const std::filesystem::path& model,
                                const std::string& medium, const DenseOptions& options);

// Returns the CPU time [s] that DensifyPointCloud took when densified() made the folder `dense`.
// Error that names the file if the time cannot be read.
double densify_seconds(const std::filesystem::path& dense);

// Fuses the depth maps in `dense` again, with other options of fusion. `dense` and `options`: the
// result and the options of densified(). `fusion`: further options of DensifyPointCloud.
// Precondition: `fusion` contains no options of matching. Returns the folder of the cloud, which is
// `dense`/`name`.
std::filesystem::path fused_again(const Chain& chain, const std::filesystem::path& dense,
                                  const std::string& name, const DenseOptions& options,
                                  const Words& fusion);

}  // namespace axial::experiments
