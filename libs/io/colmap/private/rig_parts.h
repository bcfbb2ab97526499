// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: the readers of the single files of rigs.
#pragma once

#include <filesystem>
#include <vector>

#include "bytes/private/only_for_io.h"
#include "io/colmap/rigs.h"

namespace axial::io {

// Read one file. Errors as for read_rigs(), but references between the files are not checked.
std::vector<Rig> read_rig_config(const std::filesystem::path& path);
std::vector<Rig> read_rigs_text(const std::filesystem::path& path);
std::vector<Rig> read_rigs_binary(const std::filesystem::path& path);
std::vector<RigFrame> read_frames_text(const std::filesystem::path& path);
std::vector<RigFrame> read_frames_binary(const std::filesystem::path& path);

}  // namespace axial::io
