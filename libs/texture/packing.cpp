// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture/packing.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "base/error.h"
#include "stb_packer.h"

namespace axial::texture {
namespace {

constexpr int kLargest = 32768;

class TextureSides {
 public:
  explicit TextureSides(const PackingOptions& options)
      : multiple_(options.multiple), max_(options.max_size == 0 ? kLargest : options.max_size) {
    if (max_ < 16 || max_ > kLargest)
      fail("max_texture_size {}: must be 0 or from 16 to {}", options.max_size, kLargest);
    if (multiple_ < 0 || multiple_ > max_)
      fail("texture_size_multiple {}: must be from 0 to {}", multiple_, max_);
  }
  int max() const { return max_; }

  // The smallest allowed side that is not below `length`.
  int at_least(int length) const {
    int side = 1;
    if (multiple_ > 0)
      side = (length + multiple_ - 1) / multiple_ * multiple_;
    else
      while (side < length) side *= 2;
    return std::min(side, max_);
  }

  // The next larger side: twice the area or less.
  int after(int side) const {
    return multiple_ > 0 ? at_least(std::max(side + 1, side + side / 4)) : at_least(side + 1);
  }

 private:
  int multiple_, max_;
};

cv::Size scaled(cv::Size size, double scale) {
  const auto side = [scale](int length) {
    return std::max(1, static_cast<int>(std::ceil(length * scale - 1e-9)));
  };
  return {side(size.width), side(size.height)};
}

double scale_to_fit(cv::Size size, int max) {
  const int longest = std::max(size.width, size.height);
  return longest <= max ? 1 : static_cast<double>(max) / longest;
}

// Places rectangles in one texture after the other.
class Packer {
 public:
  Packer(std::span<const cv::Size> sizes, const PackingOptions& options)
      : sizes_(sizes), sides_(options) {
    packing_.places.resize(sizes.size());
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      Place& place = packing_.places[i];
      place.scale = scale_to_fit(sizes[i], sides_.max());
      if (place.scale < 1) ++packing_.scaled_down;
      const cv::Size size = size_of(i);
      area_ += static_cast<double>(size.width) * size.height;
      longest_ = std::max({longest_, size.width, size.height});
    }
  }

  Packing pack() {
    std::vector<std::size_t> left(sizes_.size());
    std::iota(left.begin(), left.end(), std::size_t{0});
    while (!left.empty()) left = fill_next(left);
    return std::move(packing_);
  }

 private:
  cv::Size size_of(std::size_t i) const { return size_at(packing_.places[i], sizes_[i]); }

  // Makes a texture for rectangles of `left`. Returns those that remain.
  std::vector<std::size_t> fill_next(const std::vector<std::size_t>& left) {
    constexpr double kFilled = 0.9;
    const double length = std::min<double>(sides_.max(), std::sqrt(area_ / kFilled));
    int side = sides_.at_least(std::max(longest_, static_cast<int>(length) + 1));
    std::vector<std::size_t> rest = fill(side, left);
    while (!rest.empty() && side < sides_.max()) {
      side = sides_.after(side);
      rest = fill(side, left);
    }
    cut(side, left, rest);
    return rest;
  }

  // Places what fits of `left` in a square texture. Returns what does not.
  std::vector<std::size_t> fill(int side, const std::vector<std::size_t>& left) {
    std::vector<StbRect> rects(left.size());
    for (std::size_t i = 0; i < left.size(); ++i) rects[i].size = size_of(left[i]);
    pack_with_stb({side, side}, rects);
    std::vector<std::size_t> rest;
    for (std::size_t i = 0; i < left.size(); ++i) {
      if (!rects[i].corner) {
        rest.push_back(left[i]);
        continue;
      }
      Place& place = packing_.places[left[i]];
      place.texture = static_cast<std::uint32_t>(packing_.sizes.size());
      place.corner = *rects[i].corner;
    }
    return rest;
  }

  // Ends a texture with the rectangles of `left` that are not in `rest`, both in rising order.
  void cut(int side, const std::vector<std::size_t>& left, const std::vector<std::size_t>& rest) {
    std::vector<std::size_t> placed;
    std::ranges::set_difference(left, rest, std::back_inserter(placed));
    int bottom = 1;
    for (const std::size_t i : placed) {
      const cv::Size size = size_of(i);
      bottom = std::max(bottom, packing_.places[i].corner.y + size.height);
      area_ -= static_cast<double>(size.width) * size.height;
    }
    packing_.sizes.emplace_back(side, sides_.at_least(bottom));
  }

  std::span<const cv::Size> sizes_;
  TextureSides sides_;
  Packing packing_;
  double area_ = 0;  // of the rectangles that are not placed [px]
  int longest_ = 1;
};

}  // namespace

cv::Size size_at(const Place& place, cv::Size size) {
  return scaled(size, place.scale);
}

Packing pack(std::span<const cv::Size> sizes, const PackingOptions& options) {
  return Packer(sizes, options).pack();
}

}  // namespace axial::texture
