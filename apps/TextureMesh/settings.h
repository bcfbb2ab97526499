// SPDX-License-Identifier: GPL-3.0-or-later
// TextureMesh's options: the options of OpenMVS with the same names and defaults, and the options
// for refraction. Only --sharpness-weight has another default.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "axial/survey.h"
#include "axial/texture.h"
#include "base/program/program.h"
#include "boundary/options.h"
#include "io/textured/textured_mesh.h"

namespace axial::apps {

struct Settings {
  survey::Options survey;
  std::filesystem::path mesh, output;  // the extension of the output is .mvs, as in OpenMVS
  std::vector<io::TexturedFormat> formats;
  double decimate = 1;           // fraction of the faces that are kept before texturing
  std::size_t close_holes = 30;  // with `decimate` below 1: CleanOptions::close_holes
  boundary::Options boundary;    // faces outside are left out
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
