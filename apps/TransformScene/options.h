// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "base/program.h"
#include "io/openmvs/scene_with_cameras.h"

namespace axial::apps {

struct Options {
  ParsedOptions parsed;
  io::SceneFiles files;  // the scene and its housing
  std::filesystem::path cloud, mesh, output;
  // At most one of these says how to move.
  std::filesystem::path align, transform, positions;
  bool rigid = false;        // align without scale
  bool scale_ports = false;  // lengths of ports change with the scale
  std::filesystem::path transform_out;
  bool compute_volume = false;
  double plane_threshold = 0;  // [m]; 0: automatic, negative: no ground plane
  int up_axis = 2;
  unsigned max_resolution = 0;  // 0: images stay

  bool moves() const { return !align.empty() || !transform.empty() || !positions.empty(); }
  bool writes_scene() const { return moves() || max_resolution > 0; }
};

// Parses and checks the command line. `parsed.run` is false if nothing is left to do.
Options parse_command_line(int argc, const char* const* argv);

}  // namespace axial::apps
