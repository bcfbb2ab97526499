// SPDX-License-Identifier: GPL-3.0-or-later
// Calibmar's calibration.yaml: one camera, its lens in air and its port (docs/formats.md).
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "io/colmap.h"

namespace axial::io {

// True for names that end in .yaml or .yml.
bool is_calibmar(const std::filesystem::path& path);

// The camera, with id 1 and the port if the file has one; pixel centres at 0.5, as in COLMAP's
// files. Keys that say nothing about it, such as a stereo camera's place, are passed over. Error
// that names file, key and value for a key that is missing or occurs twice, a number that is none,
// a model COLMAP does not have, a wrong count of parameters, a port that cannot be.
ColmapCamera read_calibmar(const std::filesystem::path& path);

// Whether the file says that the camera has no port, "non_svp_model: NONE" or an empty one. False
// where that key is missing. Error as for read_calibmar.
bool says_no_port(const std::filesystem::path& path);

// `comments`: lines to put in front.
void write_calibmar(const std::filesystem::path& path, const ColmapCamera& camera,
                    std::span<const std::string> comments = {});

}  // namespace axial::io
