// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: the files that files of meshes name.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "bytes/private/only_for_io.h"

namespace axial::io {

// Returns the existing file that `name` names from `folder`, or nothing. Programs on Windows write
// names in another case than the files have, and with '\' between folders. So if there is no file
// of this very name, these are tried in turn: '/' in place of '\', then the only file whose name
// differs by the case of letters alone (in any folder of the path), then the file in `folder`
// itself with the last part of the name.
std::optional<std::filesystem::path> file_beside(const std::filesystem::path& folder,
                                                 const std::string& name);

// The result of file_beside(), or `folder`/`name` if there is no such file, for an error when the
// file is read.
std::filesystem::path path_beside(const std::filesystem::path& folder, const std::string& name);

// The file that a relative URI names from `folder`. %XX stands for a byte. A URI whose bytes are
// not escaped, which the format forbids but programs write, is found, too.
std::filesystem::path file_of_uri(const std::filesystem::path& folder, const std::string& uri);

// The bytes of a URI "data:TYPE;base64,BYTES" or "data:TYPE,BYTES", whose characters may be escaped
// as %XX. Error that begins with `owner` for a malformed URI.
std::string bytes_of_data_uri(const std::string& uri, const std::string& owner);

}  // namespace axial::io
