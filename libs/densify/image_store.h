// SPDX-License-Identifier: GPL-3.0-or-later
// The pixels of the images at their working resolution, read when they are needed.
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>

#include "base/shared_cache.h"
#include "densify/masks.h"
#include "densify/project.h"

namespace axial::densify {

struct WorkImage {
  cv::Mat1b grey;
  cv::Mat3b color;  // B G R; empty if the settings need no colours
  cv::Mat1b mask;   // empty, or non-zero where pixels are matched: from labels and alpha
};

// The sizes on which the memory of a WorkImage depends.
struct WorkImageSize {
  std::uint64_t pixels = 0;
  bool mask = false, color = false;
};

// The memory [bytes] of a WorkImage.
std::uint64_t bytes_needed(const WorkImageSize& size);

// An upper bound of the memory [bytes] while ImageStore reads an image, without the WorkImage.
// `decode`: of the photograph (io/images/image.h). `pixels`: of the WorkImage.
std::uint64_t bytes_needed_to_load(std::uint64_t decode, std::uint64_t pixels);

// The WorkImage::mask of an image, at the size of `view.camera`. `opaque`: non-zero where pixels
// are opaque (empty: no alpha). `check` collects the labels; it may be null. Error for a mask whose
// shape differs from the photograph's.
cv::Mat1b working_mask(const View& view, const cv::Mat1b& opaque, int ignored_label,
                       LabelCheck* check = nullptr);

// Keeps the `capacity` most recently used images. Thread-safe; several threads that ask for the
// same image read it only once.
class ImageStore {
 public:
  ImageStore(const Project& project, const Settings& settings, std::size_t capacity);

  // Error for files that cannot be decoded, and for masks whose shape differs from their image's.
  std::shared_ptr<const WorkImage> get(std::size_t image) { return cache_.get(image); }

  // WorkImage::mask. Reads no file for an image without a mask.
  cv::Mat1b mask(std::size_t image);

  // Reads every calibrated image once, `at_once` at a time, so that errors show before hours of
  // work. Reports the error of the first bad image in the scene's order. Reads in reverse order:
  // the images that are needed first stay in the cache. Warns if no mask has the label to ignore.
  void check_all(std::size_t at_once);

 private:
  const Project& project_;
  LabelCheck labels_;
  SharedCache<WorkImage> cache_;
};

}  // namespace axial::densify
