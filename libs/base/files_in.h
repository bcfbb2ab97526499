// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

namespace axial {

// Returns the paths of the regular files in the folder `path`, without the files in its subfolders,
// in an unspecified order. Each result begins with `path`. If `path` is itself a regular file, the
// result is `path` alone. If `path` is empty, does not exist or cannot be opened, the result is
// empty.
inline std::vector<std::filesystem::path> files_in(const std::filesystem::path& path) {
  std::vector<std::filesystem::path> files;
  std::error_code ignored;
  if (std::filesystem::is_regular_file(path, ignored)) return {path};
  for (const auto& entry : std::filesystem::directory_iterator(path, ignored))
    if (entry.is_regular_file(ignored)) files.push_back(entry.path());
  return files;
}

}  // namespace axial
