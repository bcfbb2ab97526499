// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "axial/survey.h"
#include "base/program/program.h"
#include "base/program/tiling.h"
#include "boundary/options.h"
#include "mesh/reconstruct.h"

namespace axial::apps {

struct Options {
  ParsedOptions parsed;
  survey::Options survey;
  std::filesystem::path cloud;   // empty: <scene>.ply if it exists, otherwise the scene's points
  std::filesystem::path mesh;    // mesh to clean; empty: reconstruct a mesh
  std::filesystem::path output;  // .ply, .obj or .glb
  double roi_border = 0;
  Tiling tiling;
  boundary::Options boundary;  // faces outside are removed
  bool close_unseen = false;   // mark surface that no two cameras see instead of removing it
  mesh::ReconstructOptions reconstruct;
};

// Parses and checks the command line. Error for an unknown option and for a wrong value.
// `parsed.run` is false if nothing is left to do, for example after --help.
Options parse_command_line(int argc, const char* const* argv);

}  // namespace axial::apps
