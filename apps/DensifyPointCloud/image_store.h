// SPDX-License-Identifier: GPL-3.0-or-later
// The pixels of the images at their working resolution, read when somebody needs them.
#pragma once

#include <memory>
#include <opencv2/core.hpp>

#include "base/shared_cache.h"
#include "masks.h"
#include "project.h"

namespace densify {

struct WorkImage {
  cv::Mat1b grey;
  cv::Mat3b color;  // B G R; empty if the options need no colours
  cv::Mat1b mask;   // empty, or non-zero: match; of the labels and of the pixels' own alpha
};

// WorkImage::mask of an image whose pixels' alpha is `opaque` (empty: none), at `view.camera`'s
// size. `check` learns the labels (null: nobody does). Error for a mask of another shape.
cv::Mat1b working_mask(const View& view, const cv::Mat1b& opaque, int ignored_label,
                       LabelCheck* check = nullptr);

// Keeps the `capacity` images that were used last. Thread-safe; an image is read once however many
// threads want it.
class ImageStore {
 public:
  ImageStore(const Project& project, const Options& options, std::size_t capacity);

  // Error for files that cannot be decoded, and for masks of another shape than their image.
  std::shared_ptr<const WorkImage> get(std::size_t image) { return cache_.get(image); }

  // WorkImage::mask. Reads nothing for an image that has none.
  cv::Mat1b mask(std::size_t image);

  // Reads every calibrated image once, `at_once` at a time, so that errors show before hours of
  // work: that of the first bad image in the scene. The first images stay, which are needed first.
  // A warning if no mask has the label to leave out.
  void check_all(std::size_t at_once);

 private:
  const Project& project_;
  LabelCheck labels_;
  axial::SharedCache<WorkImage> cache_;
};

}  // namespace densify
