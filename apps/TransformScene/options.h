// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "axial/survey.h"
#include "base/file_extension.h"
#include "base/program/program.h"

namespace axial::apps {

struct Options {
  ParsedOptions parsed;
  std::filesystem::path input;  // a scene, or a cloud that is written as LAS
  int epsg = 0;                 // for LAS; 0: no coordinate reference system
  survey::Options survey;       // not set for a cloud
  std::filesystem::path cloud, mesh, output;
  // The three ways to move the scene. At most one of these files is given.
  std::filesystem::path align, transform, positions;
  bool rigid = false;        // align without a change of scale
  bool scale_ports = false;  // the lengths of ports change with the scale
  std::filesystem::path transform_out;
  bool compute_volume = false;
  double plane_threshold = 0;       // GroundOptions::threshold [m]; negative: no ground plane
  int up_axis = 2;                  // GroundOptions::up_axis
  double sample_mesh = 0;           // see write_samples(); 0: no samples
  std::string export_type = "ply";  // of the moved mesh: ply, obj, glb or gltf
  unsigned max_resolution = 0;      // longest side of an image [px]; 0: images stay as they are

  bool converts = false;  // the mesh is written in export_type, moved or not

  bool is_cloud() const { return lower_extension(input) == ".ply"; }
  bool moves() const { return !align.empty() || !transform.empty() || !positions.empty(); }
  bool writes_mesh() const { return !mesh.empty() && (moves() || converts); }
  bool writes_scene() const { return moves() || max_resolution > 0; }
};

// Parses and checks the command line. Error for an unknown option and for a wrong value.
// `parsed.run` is false if nothing is left to do, for example after --help.
Options parse_command_line(int argc, const char* const* argv);

}  // namespace axial::apps
