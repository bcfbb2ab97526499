// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

namespace axial {

// Returns the regular files in the folder `path`, without the files in its subfolders, in any
// order. If `path` is itself a file, the result is that file. If `path` is empty or does not exist,
// the result is empty.
inline std::vector<std::filesystem::path> files_in(const std::filesystem::path& path) {
  std::vector<std::filesystem::path> files;
  std::error_code ignored;
  if (std::filesystem::is_regular_file(path, ignored)) return {path};
  for (const auto& entry : std::filesystem::directory_iterator(path, ignored))
    if (entry.is_regular_file(ignored)) files.push_back(entry.path());
  return files;
}

}  // namespace axial
