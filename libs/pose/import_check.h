// SPDX-License-Identifier: GPL-3.0-or-later
// Checks whether a COLMAP model, its housing and its photographs belong together.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "io/cameras/housing.h"
#include "io/colmap/colmap.h"

namespace axial::pose {

// A warning of one line if `model`, with its cameras behind the ports of `housing`, does not fit
// its tracks or its photographs. Empty if everything fits or if the data cannot tell (port_check.h
// says when tracks can tell). Triangulates a bounded sample of the points anew.
//
// Tracks that fit cameras in air may come from photographs in air. Then up to six photographs of
// `image_folder` decide; with an empty path there is no warning. Tracks of a model that carries
// ports itself always come from photographs taken through these ports. The line is the same for any
// number of threads.
//
// Poses at too large a scale are not found here: their points move by about a pixel, and patches
// hardly show that. The depth maps of DensifyPointCloud show it (depth/agreement.h).
//
// Throws nothing for files that cannot be read.
std::optional<std::string> import_warning(const io::ColmapModel& model, const io::Housing& housing,
                                          const std::filesystem::path& image_folder);

}  // namespace axial::pose
