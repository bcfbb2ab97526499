// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "axial/refine.h"
#include "axial/survey.h"
#include "base/program/program.h"
#include "mesh/clean.h"

namespace axial::apps {

struct Options {
  ParsedOptions parsed;
  survey::Options survey;
  std::filesystem::path mesh;    // .ply
  std::filesystem::path output;  // .ply, .obj or .glb
  double decimate = 1;           // fraction of the faces that are kept before refining
  bool close_unseen = false;     // mark surface that no two cameras see instead of removing it
  mesh::CleanOptions cleaning;   // for the refined mesh
  refine::Options refine;
};

// Parses and checks the command line. Error for an unknown option and for a wrong value.
// `parsed.run` is false if nothing is left to do, for example after --help.
Options parse_command_line(int argc, const char* const* argv);

}  // namespace axial::apps
