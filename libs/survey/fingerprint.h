// SPDX-License-Identifier: GPL-3.0-or-later
// Fingerprints of the photographs of a survey, with their masks, cameras and poses.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/hash.h"
#include "survey/survey.h"

namespace axial::survey {

// A file (.json) that keeps the fingerprints of photographs and masks, so that a run for one part
// of the images need not read all photographs of a survey. A damaged file counts as empty.
struct KeptContents {
  std::filesystem::path file;
  // Photographs and masks whose names, sizes and times of change are in the file get their
  // fingerprints from the file.
  bool read = false;
  bool write = false;  // writes the fingerprints to the file
};

// Adds the size and the pixels of an image.
void add_pixels(Fingerprint& print, const cv::Mat& pixels);

// Returns, for each view, a fingerprint of the bytes of its photograph and of its mask (of a survey
// in memory: of their pixels), and with Options::match_colors of its file of colours; empty for a
// view without a file. Reads the photographs and masks whose fingerprints are not kept. Error for a
// photograph or mask that cannot be read, and if the file of `kept` cannot be written.
std::vector<std::string> contents_of_views(const Survey& survey, const KeptContents& kept = {},
                                           const Context& context = {});

// Adds ID, camera, pose and pixels of a view at the working resolution. `content`: the element of
// contents_of_views() for the view.
void add_view(Fingerprint& print, const Survey& survey, std::size_t view,
              const std::string& content);

// A fingerprint of the cameras, poses and pixels of all views at the working resolution, with their
// masks. Reads the photographs and masks. Error for a file that cannot be read.
std::string fingerprint_of_views(const Survey& survey, const Context& context = {});

}  // namespace axial::survey
