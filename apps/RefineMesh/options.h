// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/program.h"
#include "densify/settings.h"
#include "mesh/clean.h"
#include "refine/refine.h"

namespace axial::apps {

struct Options {
  ParsedOptions parsed;
  densify::Settings scene;       // scene, images, masks, cameras and memory
  std::filesystem::path mesh;    // .ply
  std::filesystem::path output;  // .ply or .obj
  double decimate = 1;           // part of the faces to keep before refining
  mesh::CleanOptions cleaning;   // of the refined mesh
  refine::Options refine;
};

// Parses and checks the command line. `parsed.run` is false if nothing is left to do.
Options parse_command_line(int argc, const char* const* argv);

}  // namespace axial::apps
