// SPDX-License-Identifier: GPL-3.0-or-later
// Records the files that a program wrote into a folder, with fingerprints of their contents. The
// next run can then remove the files that it does not replace, and leave files that others wrote or
// changed.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <vector>

namespace axial::io {

// Lists all regular files below `folder`, at any depth. Symbolic links are left out. Returns a JSON
// object { "relative/path": "fingerprint", ... } with paths relative to `folder`. Error that names
// the file if a file cannot be read. If the folder cannot be listed, a
// std::filesystem::filesystem_error is thrown.
nlohmann::json list_files(const std::filesystem::path& folder);

// The result of find_written(). Paths are sorted and relative to the folder that was searched.
struct WrittenFiles {
  // Files whose content has the listed fingerprint.
  std::vector<std::filesystem::path> unchanged;
  std::vector<std::filesystem::path> changed;  // files with another content
};

// Returns the files of `listed` that exist as regular files in `folder`. `listed` is an earlier
// result of list_files() for `folder`. Entries that list_files() cannot have made are ignored, for
// example paths that lead out of the folder. If `listed` is not a JSON object, nothing is found.
// Error that names the file if an existing file cannot be read.
WrittenFiles find_written(const std::filesystem::path& folder, const nlohmann::json& listed);

// Removes `files`, whose paths are relative to `folder`. Then removes the folders below `folder`
// that have become empty. `folder` itself stays. Files that do not exist are passed over. If a file
// cannot be removed, a std::filesystem::filesystem_error is thrown. Precondition: no path leads out
// of `folder`.
void remove_below(const std::filesystem::path& folder,
                  const std::vector<std::filesystem::path>& files);

}  // namespace axial::io
