// SPDX-License-Identifier: GPL-3.0-or-later
// Masks of a run: which file goes with which image, and whether the label to leave out is in them.
#pragma once

#include <atomic>
#include <bitset>
#include <mutex>
#include <opencv2/core.hpp>

#include "project.h"

namespace densify {

// Sets View::mask of all calibrated images, if masks are asked for. Warnings, in the order of the
// scene, for images without a mask and where two files answer. Error where --mask-path has none.
void choose_masks(Project& project, const Options& options);

// Learns from the masks that are read whether any holds the label to leave out. Thread-safe.
class LabelCheck {
 public:
  explicit LabelCheck(int label) : label_(label) {}

  void add(const cv::Mat1w& labels);

  // Call it when all masks are read: a warning with the labels that there are, if that one is not.
  void warn_if_absent(const Project& project) const;

 private:
  const int label_;
  std::atomic<bool> seen_ = false;
  std::mutex mutex_;
  std::bitset<65536> others_;
};

}  // namespace densify
