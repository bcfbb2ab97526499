// SPDX-License-Identifier: GPL-3.0-or-later
// The file of targets that were found in photographs (docs/formats.md, "Targets").
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <span>
#include <string>
#include <vector>

#include "targets/codes/family.h"
#include "targets/fits/detection.h"

namespace axial::targets {

// The targets of one photograph.
struct Photograph {
  std::string name;  // relative to the folder of the photographs, as COLMAP names images
  cv::Size size;     // [px]
  std::vector<Detection> targets;
};

// Writes the targets of all photographs as JSON. `families`: those that were sought. The file is
// written completely or not at all. Throws an Error that names the file if it cannot be written.
void write_targets(const std::filesystem::path& path, std::span<const Family> families,
                   std::span<const Photograph> photographs);

}  // namespace axial::targets
