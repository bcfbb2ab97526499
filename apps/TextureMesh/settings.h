// SPDX-License-Identifier: GPL-3.0-or-later
// TextureMesh's options: OpenMVS's options with the same names and defaults, except
// --sharpness-weight, and the options for refraction.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "base/program.h"
#include "io/openmvs/scene_with_cameras.h"
#include "io/textured/textured_mesh.h"
#include "scene/resolution.h"
#include "texture/texture_mesh.h"

namespace axial::apps {

// What marks pixels that must not be used.
enum class MaskChoice {
  label,         // the masks' pixels with Settings::mask_label
  black_border,  // the black borders that undistortion leaves
  none
};

struct Settings {
  io::SceneFiles scene;
  std::filesystem::path mesh, output;  // the extension of the output is .mvs, as in OpenMVS
  std::vector<io::TexturedFormat> formats;
  std::filesystem::path views_file;   // empty: all views
  std::filesystem::path mask_folder;  // empty: masks of the scene, or beside the images
  MaskChoice masks = MaskChoice::black_border;
  int mask_label = 0;
  int bit_depth = 0;
  std::uint64_t max_memory = 0;  // [MB]; 0: 70 % of the free memory
  ResolutionOptions resolution{0, 640, 1 << 20};
  texture::Options texture;
};

struct Options {
  ParsedOptions parsed;
  Settings settings;
};

// Parses and checks the command line. Error for an unknown option, for a value out of range, and
// for an option of OpenMVS that is not built, unless it has its default.
Options parse_command_line(int argc, const char* const* argv);

}  // namespace axial::apps
