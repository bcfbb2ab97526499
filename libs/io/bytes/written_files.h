// SPDX-License-Identifier: GPL-3.0-or-later
// Records the files that a program wrote into a folder, with fingerprints of their contents. The
// next run can then remove the files that it does not replace, and leave files that others wrote or
// changed.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <vector>

namespace axial::io {

// Lists all regular files below `folder`, at any depth, without symbolic links: { "relative/path":
// fingerprint, ... }.
nlohmann::json list_files(const std::filesystem::path& folder);

struct WrittenFiles {
  std::vector<std::filesystem::path> unchanged;  // paths below the folder, sorted
  std::vector<std::filesystem::path> changed;    // exist with another content
};

// Finds the files of `listed` (made by list_files) that exist in `folder`. Entries that list_files
// cannot have made are ignored, for example paths that lead out of the folder.
WrittenFiles find_written(const std::filesystem::path& folder, const nlohmann::json& listed);

// Removes `files`, given relative to `folder`, and then the folders below `folder` that have become
// empty.
void remove_below(const std::filesystem::path& folder,
                  const std::vector<std::filesystem::path>& files);

}  // namespace axial::io
