// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/program/program.h"

namespace axial::apps {

struct Options {
  ParsedOptions parsed;
  std::filesystem::path input, truth;     // no truth: the input is only rendered
  std::vector<double> tolerances{0.005};  // [m], at least one
  std::string align = "none";             // none, centres, icp
  bool allow_missing = false;             // no error if the housing gives no image a port
  std::filesystem::path cameras;          // true COLMAP model; empty: none
  std::filesystem::path housing;          // ports of `cameras`; empty: no ports
  std::filesystem::path estimated;        // estimated COLMAP model; empty: none
  // The folders with the models of `cameras` and `estimated`; filled by the program.
  std::filesystem::path cameras_model, estimated_model;
  std::size_t samples = 200000;
  std::uint64_t seed = 1;
  std::uint32_t least_views = 2;
  bool framed_only = false;  // evaluate only the points inside the images of least_views cameras
  double gross = 0;          // evaluate::CloudOptions::gross [m]
  bool strip = false;        // evaluate the density along the strip of cameras
  double color_max = 0;      // error of the last colour [m]
  int picture_width = 1024;
  std::string picture_camera;               // image name; empty: the first image
  std::vector<std::string> rendered_views;  // image names, or only "all"; empty: none
  std::filesystem::path photographs;        // folder with the images; empty: no comparison
  std::string render_type = "png";          // png, jpg
  int render_samples = 3;                   // rays along each side of a pixel
  int render_width = 0;                     // width of the pictures [px]; 0: that of each camera
  // Output files, and the folder of rendered images. An empty path: not written.
  std::filesystem::path json, error_cloud, error_mesh, picture, aligned, transform, render_folder;
};

// Parses and checks the command line. Error for an unknown option and for a wrong value.
// `parsed.run` is false if nothing is left to do, for example after --help.
Options parse_command_line(int argc, const char* const* argv);

}  // namespace axial::apps
