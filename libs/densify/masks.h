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

// Sets View::mask of all calibrated images, if masks are used. Warns, in the order of the scene, of
// images without a mask and of images with two candidate files. Error if the mask folder has no
// mask for an image.
void choose_masks(Project& project, const Settings& settings);

// Collects labels of masks to tell whether any mask has the label to ignore. Thread-safe.
class LabelCheck {
 public:
  explicit LabelCheck(const Settings& settings)
      : label_(settings.ignore_mask_label), setting_(settings.name_of("ignore_mask_label")) {}

  void add(const cv::Mat1w& labels);

  // Call after all masks were read: warns with the labels found if the label to ignore is not among
  // them.
  void warn_if_absent(const Project& project) const;

 private:
  const int label_;
  const std::string setting_;  // the name of the setting of the label
  std::atomic<bool> seen_ = false;
  std::mutex mutex_;
  std::bitset<65536> others_;
};

}  // namespace axial::densify
