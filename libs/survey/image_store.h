// SPDX-License-Identifier: GPL-3.0-or-later
// The photographs of a survey, read when they are needed and kept while there is room.
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <span>

#include "base/shared_cache.h"
#include "survey/photographs.h"

namespace axial::survey {

// The sizes on which the memory of Pixels with grey levels depends.
struct PixelsSize {
  std::uint64_t pixels = 0;          // width times height
  bool mask = false, color = false;  // whether Pixels::mask and Pixels::color are filled
};

// The memory [bytes] of Pixels with grey levels.
std::uint64_t bytes_needed(const PixelsSize& size);

// An upper bound of the memory [bytes] that ImageStore needs while it reads a photograph, besides
// the resulting Pixels. `decode`: the memory [bytes] for decoding the photograph
// (io/images/image.h). `pixels`: the number of pixels of the result.
std::uint64_t bytes_needed_to_load(std::uint64_t decode, std::uint64_t pixels);

// Reads photographs when they are asked for, and keeps the `capacity` most recently used ones, and
// in addition all that are still in use outside (SharedCache). Thread-safe; several threads that
// ask for the same photograph read it only once. Photographs are named by their index in
// Survey::views. A view with an empty file is not used.
class ImageStore {
 public:
  // `survey` must outlive the object. `channels` includes grey levels.
  ImageStore(const Survey& survey, Channels channels, std::size_t capacity);

  // Returns the pixels of a view, never null. Errors as for Photographs::read().
  std::shared_ptr<const Pixels> get(std::size_t view) { return cache_.get(view); }

  // Returns Pixels::mask of a view, and throws the errors of get(). Reads no file if the view is
  // not masked.
  cv::Mat1b mask(std::size_t view);

  // Reads every photograph once, so that errors show before hours of work. Up to `at_once`
  // photographs are read at the same time. After all are read, throws the Error of the first bad
  // one in the order of the views. Warns if there are masks and none has the label to ignore. The
  // photographs are read in reverse order, so that the photographs that are needed first stay in
  // the cache.
  void check_all(std::size_t at_once, const Context& context);

  // As check_all(), but reads only `views`, and does not warn about masks.
  void check(std::span<const std::size_t> views, std::size_t at_once, const Context& context);

  const Photographs& photographs() const { return photographs_; }

 private:
  Photographs photographs_;
  SharedCache<Pixels> cache_;
};

// How the memory of a stage is divided between an ImageStore of grey levels and the other work.
struct ImageShares {
  std::size_t images = 1;  // capacity of the ImageStore
  MemoryBudget for_work;
};

// An eighth of what is left is for images, but at least two, besides the memory to read one.
ImageShares share_out(const MemoryBudget& memory, const Survey& survey);

}  // namespace axial::survey
