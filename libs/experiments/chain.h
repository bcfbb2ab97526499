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
#include "experiments/steps.h"
#include "refractive/flat_port.h"

namespace axial::experiments {

// Returns an object with the fingerprint of each program of the chain. If a part (experiment.h)
// uses the chain, Part::inputs must contain these fingerprints. Error if a program does not lie
// beside the running program.
Json programs_of_the_chain();

// Options of SimulateUnderwater (docs/options-reference.md).
struct SceneOptions {
  std::string preset = "outcrop";
  // The images have width x height pixels. views 0: the preset's number of images.
  int seed = 1, views = 10, width = 1024, height = 768;
  int samples = 2;  // rays along each side of a pixel
  // `fov_degrees`: horizontal field of view in air. `scale`: factor for the sizes of the scene and
  // the distances of the views, but not for the port. `relief`: factor for the heights of the
  // scene. `coarseness`: factor for the distances between the vertices of the true mesh.
  double fov_degrees = 80, scale = 1, relief = 1, coarseness = 1;
  std::string medium = "both";  // "air", "water" or "both"
  bool truth = true;            // keep true distances; true normals are always removed
  // Options of the port, which replace those of the preset: "--tilt-degrees", "3".
  Words port;
  // More options, each name and value in a word of its own. An option replaces the field of the
  // same name. `more` must not contain --preset, --seed, --medium or an option that is in `port`.
  Words more;
};
// Returns the words of SimulateUnderwater's command line, without the output folder, as a list.
Json to_json(const SceneOptions& options);

// A scene with ground truth. Later steps keep their folders in `folder`, too.
struct SimulatedScene {
  std::filesystem::path folder;

  // The folder of the photographs and their true distances. `medium`: "air" or "water".
  std::filesystem::path images(const std::string& medium) const { return folder / medium; }
  // The COLMAP model of the true poses and the lens in air.
  std::filesystem::path model() const { return folder / "sparse"; }
  // The true surface.
  std::filesystem::path mesh() const { return folder / "mesh.ply"; }
  // The housing file of the true port.
  std::filesystem::path housing() const { return folder / "housing.json"; }
};

// Simulates the scene of these options. The folder of the scene lies in `chain.work`. Its name
// depends on the options, so that scenes with other options have other folders.
SimulatedScene simulated(const Chain& chain, const SceneOptions& options);

// Returns the port through which all underwater images of the scene are taken, in the camera frame.
// Precondition: the port is flat.
refractive::FlatPort<double> port_of(const SimulatedScene& scene);

// The lens that COLMAP gets, and whether COLMAP refines it.
struct Calibration {
  std::string model = "PINHOLE";  // COLMAP's name of the camera model
  // The parameters of the model, in COLMAP's order: "fx,fy,cx,cy,...". Pixel centres are at halves,
  // as COLMAP has them.
  std::string parameters;
  bool refine = false;  // true: COLMAP refines the lens; false: the lens is fixed
};
// Returns the lens of the scene in air, not to be refined by COLMAP.
Calibration true_lens(const SimulatedScene& scene);
// Returns the initial lens of a self-calibration under water, to be refined by COLMAP. The model is
// OPENCV without distortion. The focal lengths are the focal lengths in air times the refractive
// index of the water. Preconditions: the lens of the scene is a pinhole (model PINHOLE) and the
// port is flat.
Calibration self_calibration(const SimulatedScene& scene);
// Returns the lens of the first camera in the COLMAP model in the folder `colmap_model`, not to be
// refined by COLMAP. Precondition: the model has a camera.
Calibration calibration_of(const std::filesystem::path& colmap_model);

// Poses and sparse points from photographs, by the script axial-colmap-model. If COLMAP found poses
// for fewer than three images, `model` is empty and the numbers are 0.
struct ColmapPoses {
  std::filesystem::path model;  // folder; aligned with the true camera centres, in metres
  std::size_t images = 0;       // number of images for which COLMAP found poses
  double centre_rms = 0;        // [m], RMS error of the aligned camera centres
};
// Computes poses for the photographs of `medium` ("air" or "water") with COLMAP. The results lie in
// the folder `name` of the scene. A call with another medium or calibration needs another `name`,
// because it replaces the results in the folder. COLMAP's poses are not reproducible, so COLMAP
// runs again only if the medium or the calibration changes.
ColmapPoses colmap_poses(const Chain& chain, const std::string& name, const SimulatedScene& scene,
                         const std::string& medium, const Calibration& calibration);

struct DenseOptions {
  std::filesystem::path housing;  // housing file; empty: the cameras are taken to have no ports
  Words more;                     // more options of DensifyPointCloud
  // What densified() does if no image can be matched. true: it returns an empty path. false: Error.
  bool or_nothing = false;
};
// Computes depth maps and a dense cloud from the photographs of `medium` ("air" or "water") and the
// poses of the COLMAP model in the folder `model`. Returns the folder of the depth maps (*.dmap)
// and the cloud (scene_dense.ply), which is the folder `name` of the scene. A call with other
// arguments needs another `name`, because it replaces the results in the folder. With
// `options.or_nothing`, returns an empty path if no image can be matched.
std::filesystem::path densified(const Chain& chain, const std::string& name,
                                const SimulatedScene& scene, const std::filesystem::path& model,
                                const std::string& medium, const DenseOptions& options);

// Returns the CPU time [s] that DensifyPointCloud took when densified() made the folder `dense`.
// Throws an Error that names the file of the time if this file cannot be read.
double densify_seconds(const std::filesystem::path& dense);

// Fuses the depth maps in `dense` again, with other options of fusion. `dense` and `options`: the
// result and the options of densified(). `fusion`: options of DensifyPointCloud, which are added to
// `options.more`. Precondition: `fusion` contains no options of matching. Returns the folder of the
// cloud (scene_dense.ply), which is `dense`/`name`.
std::filesystem::path fused_again(const Chain& chain, const std::filesystem::path& dense,
                                  const std::string& name, const DenseOptions& options,
                                  const Words& fusion);

}  // namespace axial::experiments
