// SPDX-License-Identifier: GPL-3.0-or-later
// Calibmar's calibration.yaml: one camera with its lens in air and its port (docs/formats.md).
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "axial/base.h"
#include "io/colmap/colmap.h"

namespace axial::io {

// True for file names that end in .yaml or .yml, in upper or lower case.
bool is_calibmar(const std::filesystem::path& path);

// Reads the camera, with its port if the file describes one. Lengths of the port are in metres. The
// id of the camera is 1. Pixel centres are at 0.5, as in COLMAP's files. Keys that do not describe
// this camera are ignored, for example the pose of a stereo camera. A normal whose length differs
// from 1 by more than 1e-6 is normalised with a warning of `context`.
//
// Error that names the file, the key and the value for a file that cannot be read, a missing or
// repeated key, a malformed number, a camera model that COLMAP does not have, a wrong number of
// parameters, or port values that are not possible.
ColmapCamera read_calibmar(const std::filesystem::path& path, const Context& context = {});

// True if the file states that the camera has no port: its key "non_svp_model" is NONE or empty.
// False if the key "non_svp_model" is missing or has another value. Error if the file cannot be
// read or is malformed. The values of other keys are not checked.
bool says_no_port(const std::filesystem::path& path);

// Writes `camera`, with its port if it has one, and replaces an existing file. The id of the camera
// is not written. `comments` are the lines at the top of the file: "# " is put before each of them.
// Preconditions: no comment contains a line break, and read_calibmar() would accept the values of
// `camera` (they are not checked). Error that names the file if it cannot be written.
void write_calibmar(const std::filesystem::path& path, const ColmapCamera& camera,
                    std::span<const std::string> comments = {});

}  // namespace axial::io
