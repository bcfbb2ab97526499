// SPDX-License-Identifier: GPL-3.0-or-later
// TextureMesh's options: the options of OpenMVS with the same names and defaults, and the options
// for refraction. Only --sharpness-weight has another default.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "base/program.h"
#include "io/openmvs/scene_with_cameras.h"
#include "io/textured/textured_mesh.h"
#include "texture/photographs.h"
#include "texture/texture_mesh.h"

namespace axial::apps {

struct Settings {
  io::SceneFiles scene;
  std::filesystem::path mesh, output;  // the extension of the output is .mvs, as in OpenMVS
  std::vector<io::TexturedFormat> formats;
  texture::PhotographOptions photographs;
  double decimate = 1;           // fraction of the faces that are kept before texturing
  std::size_t close_holes = 30;  // with `decimate` below 1: CleanOptions::close_holes
  std::uint64_t max_memory = 0;  // [MB]; 0: 70 % of the free memory
  texture::Options texture;
};

struct Options {
  ParsedOptions parsed;
  Settings settings;
};

// Parses and checks the command line. Error for an unknown option, for a value out of range, and
// for an option of OpenMVS that TextureMesh does not have, unless it has its default value.
Options parse_command_line(int argc, const char* const* argv);

}  // namespace axial::apps
