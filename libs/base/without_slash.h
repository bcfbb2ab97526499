// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace axial {

// Turns "out/" into "out", so that a file that belongs to a folder can lie beside the folder and
// not in it. Returns a path without a slash at its end unchanged.
inline std::filesystem::path without_slash(const std::filesystem::path& path) {
  return path.has_filename() ? path : path.parent_path();
}

}  // namespace axial
