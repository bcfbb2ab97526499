// SPDX-License-Identifier: GPL-3.0-or-later
// The photographs that are read and written.
#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>
#include <vector>

#include "color/observations.h"
#include "color/restore.h"
#include "options.h"
#include "report.h"
#include "survey/survey.h"

namespace axial::apps {

// The light of a photograph, and the pixels that may be used (0: not; empty: all).
struct PhotographLight {
  cv::Mat3f light;
  cv::Mat1b mask;
};
PhotographLight read_light(const survey::Survey& survey, std::size_t view,
                           const color::Transfer& transfer);

geometry::PosedCamera posed(const survey::View& view);

// The exposure by which the light of a view's photograph is divided.
Eigen::Array3f exposure_of(const Findings& findings, std::size_t view);

// The files of a run below the folder of the output.
struct OutputNames {
  // Of the views' photographs: their paths below the folder that contains them all. JPEG and PNG
  // keep their names; other photographs become PNG.
  std::vector<std::filesystem::path> photographs;
  std::vector<std::filesystem::path> masks;  // of the views; empty without Settings::masks
};
OutputNames output_names(const Settings& settings, const survey::Survey& survey);

// Error if two outputs have one name, or if an output is an input.
void check_outputs(const Settings& settings, const survey::Survey& survey,
                   const OutputNames& names);

// The photograph of a view without water.
color::Restored restored_photograph(const survey::Survey& survey, const color::SeenSurface& surface,
                                    const Findings& findings, std::size_t view);

// The memory [bytes] of restored_photograph() besides the surface, for the largest photograph. With
// Settings::chart, that of find_white() (white.h), which is larger.
std::uint64_t bytes_to_restore(const Settings& settings, const survey::Survey& survey);

}  // namespace axial::apps
