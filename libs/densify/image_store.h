// SPDX-License-Identifier: GPL-3.0-or-later
// The pixels of the images at their working resolution, read when they are needed.
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <span>

#include "base/shared_cache.h"
#include "densify/masks.h"
#include "densify/project.h"

namespace axial::densify {

// The pixels of one image. All members that are not empty have the size of View::camera.
struct WorkImage {
  cv::Mat1b grey;
  cv::Mat3b color;  // B G R; empty if the settings need no colours (needs_colors())
  cv::Mat1b mask;   // 0: the pixel is not matched; empty: all are matched. See working_mask()
};

// The sizes on which the memory of a WorkImage depends.
struct WorkImageSize {
  std::uint64_t pixels = 0;          // width times height
  bool mask = false, color = false;  // whether WorkImage::mask and WorkImage::color are filled
};

// The memory [bytes] of a WorkImage.
std::uint64_t bytes_needed(const WorkImageSize& size);

// An upper bound of the memory [bytes] that ImageStore needs while it reads an image, besides the
// resulting WorkImage. `decode`: the memory [bytes] for decoding the photograph
// (io/images/image.h). `pixels`: the number of pixels of the WorkImage.
std::uint64_t bytes_needed_to_load(std::uint64_t decode, std::uint64_t pixels);

// Returns WorkImage::mask of an image, at the size of `view.camera`. A pixel is non-zero if its
// label in the file `view.mask` is not `ignored_label` and if `opaque`, resampled, is 255 there.
// The result is empty if `view.mask` and `opaque` are both empty. `opaque`: of the photograph's
// size, 0 where the photograph is fully transparent and 255 elsewhere; empty: nowhere transparent.
// `check`: collects the labels; may be null. Throws an Error for a mask that cannot be read or
// whose shape differs from the photograph's.
cv::Mat1b working_mask(const View& view, const cv::Mat1b& opaque, int ignored_label,
                       LabelCheck* check = nullptr);

// Reads images when they are asked for, and keeps the `capacity` most recently used ones, and in
// addition all that are still in use outside (SharedCache). Thread-safe; several threads that ask
// for the same image read it only once. Images are named by their index in Project::views.
class ImageStore {
 public:
  // `project` and `settings` must outlive the object.
  ImageStore(const Project& project, const Settings& settings, std::size_t capacity);

  // Returns the pixels of a calibrated image, never null. Throws an Error for files that cannot be
  // decoded, and for masks whose shape differs from their image's.
  std::shared_ptr<const WorkImage> get(std::size_t image) { return cache_.get(image); }

  // Returns WorkImage::mask of an image, and throws the errors of get(). Reads no file if the image
  // has neither a mask nor alpha.
  cv::Mat1b mask(std::size_t image);

  // Reads every calibrated image once, so that errors show before hours of work. Up to `at_once`
  // images are read at the same time. After all are read, throws the Error of the first bad image
  // in the scene's order. Warns if there are masks and none has the label to ignore. The images are
  // read in reverse order, so that the images that are needed first stay in the cache.
  void check_all(std::size_t at_once);

  // As check_all(), but reads only the images Project::part and their sources, and does not warn
  // about masks.
  void check_part(std::size_t at_once);

 private:
  void check(std::span<const std::size_t> images, std::size_t at_once);

  const Project& project_;
  LabelCheck labels_;
  SharedCache<WorkImage> cache_;
};

}  // namespace axial::densify
