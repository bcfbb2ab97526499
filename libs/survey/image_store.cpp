// SPDX-License-Identifier: GPL-3.0-or-later
#include "survey/image_store.h"

#include <algorithm>
#include <vector>

#include "base/first_error.h"
#include "base/parallel.h"

namespace axial::survey {

std::uint64_t bytes_needed(const PixelsSize& size) {
  return (1 + (size.mask ? 1 : 0) + (size.color ? 3 : 0)) * size.pixels;
}

std::uint64_t bytes_needed_to_load(std::uint64_t decode, std::uint64_t pixels) {
  // Colours and grey levels at the working resolution.
  return decode + (3 + 1) * pixels;
}

ImageStore::ImageStore(const Survey& survey, Channels channels, std::size_t capacity)
    : photographs_(survey),
      cache_([this, channels](std::size_t view) { return photographs_.read(view, channels); },
             capacity) {}

cv::Mat1b ImageStore::mask(std::size_t view) {
  const Survey& survey = photographs_.survey();
  const bool masked = survey.views[view].masked() || survey.options.ignore_black_border;
  return masked ? get(view)->mask : cv::Mat1b();
}

void ImageStore::check_all(std::size_t at_once, const Context& context) {
  std::vector<std::size_t> views;
  const std::vector<View>& all = photographs_.survey().views;
  for (std::size_t v = 0; v < all.size(); ++v)
    if (!all[v].file.empty()) views.push_back(v);
  check(views, at_once, context);
  photographs_.check_labels(context);
}

void ImageStore::check(std::span<const std::size_t> views, std::size_t at_once,
                       const Context& context) {
  const std::size_t count = views.size();
  ProgressCounter counter(context.stage("Read images"), count);
  FirstError error;
  for_each_in_flight(count, at_once, [&](std::size_t i) {
    const std::size_t view = views[count - 1 - i];
    error.run(view, [&] { get(view); });
    counter.add();
  });
  error.rethrow();
}

ImageShares share_out(const MemoryBudget& memory, const Survey& survey) {
  std::uint64_t image = 0, decode = 0;
  for (const View& view : survey.views) {
    const std::uint64_t pixels = view.pixels();
    image = std::max(image, bytes_needed({pixels, view.masked(), false}));
    decode = std::max(decode, bytes_needed_to_load(view.decoding_bytes(), pixels));
  }
  const std::uint64_t left = memory.left();
  const std::uint64_t room = left - std::min(left, decode);
  ImageShares shares;
  shares.images = std::clamp<std::size_t>(room / 8 / std::max<std::uint64_t>(image, 1), 2,
                                          std::max<std::size_t>(survey.views.size(), 2));
  const std::uint64_t images = std::min(room, shares.images * image);
  shares.for_work = MemoryBudget::of_bytes(room - images);
  return shares;
}

}  // namespace axial::survey
