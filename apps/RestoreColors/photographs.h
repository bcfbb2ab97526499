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

// Restores and writes all photographs, and with Settings::masks the masks, into `folder`. Returns
// the share of pixels whose colour is determined.
double write_restored(const Settings& settings, const survey::Survey& survey,
                      const color::SeenSurface& surface, const Findings& findings,
                      const OutputNames& names, const std::filesystem::path& folder,
                      const Context& context);

// The view whose photograph has Settings::grey. Error if not exactly one photograph's path ends
// with the name, and if the part lies outside the photograph.
std::size_t view_of_grey(const GreyPatch& grey, const survey::Survey& survey);

// The gains by which Settings::grey is grey, as bright as by Findings::gain. Errors as for
// view_of_grey(), and if its light is not known.
Eigen::Array3f grey_gain(const Settings& settings, const survey::Survey& survey,
                         const color::SeenSurface& surface, const Findings& findings);

// The memory [bytes] of write_restored() besides the surface, for the largest photograph.
std::uint64_t bytes_to_restore(const survey::Survey& survey);

}  // namespace axial::apps
