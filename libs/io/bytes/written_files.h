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
// object { "relative/path": fingerprint, ... } with paths relative to `folder`.
nlohmann::json list_files(const std::filesystem::path& folder);

struct WrittenFiles {
  // Sorted paths relative to the folder. A file is unchanged if its content has the listed
  // fingerprint, otherwise changed.
  std::vector<std::filesystem::path> unchanged;
  std::vector<std::filesystem::path> changed;
};

// Returns the files of `listed` that exist as regular files in `folder`. `listed` is a result of
// list_files. Entries that list_files cannot have made are ignored, for example paths that lead out
// of the folder.
WrittenFiles find_written(const std::filesystem::path& folder, const nlohmann::json& listed);

// Removes `files`, whose paths are relative to `folder`. Also removes the folders below `folder`
// that become empty. `folder` itself stays.
void remove_below(const std::filesystem::path& folder,
                  const std::vector<std::filesystem::path>& files);

}  // namespace axial::io
