// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "io/cameras/housing.h"
#include "io/colmap/colmap.h"

namespace axial::apps {

// For each lens in air behind its port, writes the lens with which COLMAP should start
// (pose/effective_lens.h), as a cameras.txt of COLMAP with the ids of `lenses`. `distance`: of the
// scene [m]. Error that names the lens's file if a lens does not see through its port.
void write_effective_lenses(const std::filesystem::path& file,
                            const std::vector<io::ColmapCamera>& lenses, const io::Housing& housing,
                            double distance, const std::filesystem::path& lens_file);

}  // namespace axial::apps
