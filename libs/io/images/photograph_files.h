// SPDX-License-Identifier: GPL-3.0-or-later
// The photographs in a folder.
#pragma once

#include <filesystem>
#include <vector>

namespace axial::io {

// Returns the files in `folder` with the extension .jpg, .jpeg, .png, .tif, .tiff or .bmp in upper
// or lower case, in the order of their paths. Files whose names begin with a dot are left out.
// `with_subfolders`: also the files in all subfolders. Throws an Error that names the folder if it
// has no such file.
std::vector<std::filesystem::path> photographs_in_folder(const std::filesystem::path& folder,
                                                         bool with_subfolders);

}  // namespace axial::io
