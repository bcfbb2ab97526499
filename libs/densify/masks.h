// SPDX-License-Identifier: GPL-3.0-or-later
// The masks of a run: the mask file of each image, and a check that the label to ignore occurs.
#pragma once

#include <atomic>
#include <bitset>
#include <mutex>
#include <opencv2/core.hpp>
#include <string>

#include "densify/project.h"

namespace axial::densify {

// Sets View::mask of all calibrated images. If masks are not used (Settings::ignore_mask_label is
// negative), sets nothing and only logs which masks are not used. Throws an Error if
// Settings::mask_folder is set and the folder has no mask for an image. If mask_folder is empty, an
// image without a mask is reported in a warning, and its View::mask stays empty. A further warning
// tells how many images have two different masks, of which only one is used. No mask is read.
void choose_masks(Project& project, const Settings& settings);

// Collects labels of masks to tell whether any mask has the label to ignore,
// Settings::ignore_mask_label. Thread-safe.
class LabelCheck {
 public:
  explicit LabelCheck(const Settings& settings)
      : label_(settings.ignore_mask_label), setting_(settings.name_of("ignore_mask_label")) {}

  // Adds the labels of one mask. Precondition: the label to ignore is not negative.
  void add(const cv::Mat1w& labels);

  // Warns if masks were added and none has the label to ignore. The warning lists the ten smallest
  // labels that were found. `project`: its views name the masks that were added. Call this function
  // after all masks were read.
  void warn_if_absent(const Project& project) const;

 private:
  const int label_;
  const std::string setting_;  // the name of `ignore_mask_label` in messages
  std::atomic<bool> seen_ = false;
  std::mutex mutex_;
  std::bitset<65536> others_;
};

}  // namespace axial::densify
