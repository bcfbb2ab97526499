// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>

#include "targets/targets_file.h"

namespace axial::apps {

// Writes an enlarged picture of each target of `found` to `folder`, with a cross at its centre:
// "<name of the photograph>/target-7.jpg". `photograph`: its pixels, B G R of 8 bits. A label that
// the photograph shows again gets "-2", "-3" and so on behind it.
void write_pictures(const std::filesystem::path& folder, const cv::Mat3b& photograph,
                    const targets::Photograph& found);

}  // namespace axial::apps
