// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a COLMAP model, its housing and its photographs belong together, in one line.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "io/colmap.h"
#include "io/housing.h"

namespace axial::pose {

// A warning for a model whose lenses look through `housing`, or nothing where all fits or nothing
// can be told (port_check.h says what can). Points are triangulated anew, a bounded sample of them.
// Where tracks fit in air they may be of photographs in air, and up to six photographs of
// `image_folder` decide; with an empty path nothing is said then. (Tracks of a model that carries
// ports itself are of photographs through them.) The line is the same for any number of threads.
// Poses that are too large are not told there: points move by a pixel, which patches hardly show.
// DensifyPointCloud's depth maps tell (depth/agreement.h).
// Nothing is thrown for files that cannot be read.
std::optional<std::string> import_warning(const io::ColmapModel& model, const io::Housing& housing,
                                          const std::filesystem::path& image_folder);

}  // namespace axial::pose
