// SPDX-License-Identifier: GPL-3.0-or-later
// Files that belong to photographs and lie in a folder of their own, in the same subfolders.
#pragma once

#include <filesystem>
#include <vector>

namespace axial::io {

// Let an end be one or more of the last components of the path `of`, a folder of photographs, for
// example cam0 of /dive/cam0. Returns the ends that exist as subfolders of `folder`, the longest
// end first, and an empty path, which stands for `folder` itself, last.
std::vector<std::filesystem::path> folder_ends(const std::filesystem::path& folder,
                                               const std::filesystem::path& of);

}  // namespace axial::io
