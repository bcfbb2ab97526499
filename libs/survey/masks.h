// SPDX-License-Identifier: GPL-3.0-or-later
// The masks of a survey: the mask file of each photograph, and a check that the label to ignore
// occurs.
#pragma once

#include <atomic>
#include <bitset>
#include <mutex>
#include <opencv2/core.hpp>
#include <span>

#include "survey/survey.h"

namespace axial::survey {

// Sets View::mask of all views. If masks are not used (Options::ignore_mask_label is negative),
// sets nothing and only says which masks are not used. Error if Options::mask_folder is set and the
// folder has no mask for a photograph. If mask_folder is empty, a photograph without a mask is
// reported in a warning, and its View::mask stays empty. A further warning tells how many
// photographs have two different masks, of which only one is used. No mask is read.
void choose_masks(Survey& survey, const Context& context);

// Collects labels of masks to tell whether any mask has the label to ignore. Thread-safe.
class LabelCheck {
 public:
  // `label`: the label to ignore, which the warning calls the setting "ignore_mask_label".
  explicit LabelCheck(int label) : label_(label) {}

  // Adds the labels of one mask. Precondition: the label to ignore is not negative.
  void add(const cv::Mat1w& labels);

  // Warns if masks were added and none has the label to ignore. The warning lists the ten smallest
  // labels that were found. `views`: they name the masks that were added. Call this function after
  // all masks were read.
  void warn_if_absent(std::span<const View> views, const Context& context) const;

 private:
  const int label_;
  std::atomic<bool> seen_ = false;
  std::mutex mutex_;
  std::bitset<65536> others_;
};

}  // namespace axial::survey
