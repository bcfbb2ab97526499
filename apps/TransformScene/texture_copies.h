// SPDX-License-Identifier: GPL-3.0-or-later
// The textures of a PLY file that is written to another folder.
#pragma once

#include <filesystem>
#include <vector>

namespace axial::apps {

struct TextureCopy {
  std::filesystem::path from, to;
  bool needed = true;  // false: the file `to` exists already, with the same bytes
};

// Returns the textures of the PLY file `input`, and the places where `output` needs them: a PLY
// file names its textures relative to its folder, and `output` has the same names. The result has
// one entry for each texture, also if both folders are the same. Writes nothing. Errors that name
// the file, if the folders differ: a texture is missing; its relative name leads out of the folder
// of `input`, so that its copy would lie outside of the folder of `output`; or another file has the
// place of its copy. Error for a PLY with a malformed header.
std::vector<TextureCopy> texture_copies(const std::filesystem::path& input,
                                        const std::filesystem::path& output);

}  // namespace axial::apps
