// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "base/program.h"
#include "mesh/reconstruct.h"
#include "survey/options.h"

namespace axial::apps {

struct Options {
  ParsedOptions parsed;
  survey::Options survey;
  std::filesystem::path cloud;   // empty: <scene>.ply if it exists, otherwise the scene's points
  std::filesystem::path mesh;    // mesh to clean; empty: reconstruct a mesh
  std::filesystem::path output;  // .ply, .obj or .glb
  double roi_border = 0;
  std::size_t tiles = 1;      // 1: the mesh is made in one piece
  bool close_unseen = false;  // mark surface that no two cameras see instead of removing it
  std::size_t tile = 0;       // from 1: make only this tile; 0: make and join all tiles
  mesh::ReconstructOptions reconstruct;
};

inline constexpr std::size_t kMostTiles = 1000;

// Parses and checks the command line. Error for an unknown option and for a wrong value.
// `parsed.run` is false if nothing is left to do, for example after --help.
Options parse_command_line(int argc, const char* const* argv);

}  // namespace axial::apps
