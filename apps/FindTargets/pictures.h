// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>

#include "targets/targets_file.h"

namespace axial::apps {

// Writes an enlarged picture (.jpg) of each target of `found` to `folder`, with a cross at its
// centre. `pixels`: the photograph, B G R of 8 bits. Names: the photograph's name without its
// extension, with "_" for "/", and the label.
void write_pictures(const std::filesystem::path& folder, const cv::Mat3b& pixels,
                    const targets::Photograph& found);

}  // namespace axial::apps
