// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture/packing.h"

#include <algorithm>
#include <cmath>
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

// Places what fits of `left` in a texture of this size, and removes it from `left`.
void fill(cv::Size texture, std::uint32_t index, std::span<const cv::Size> sizes,
          std::vector<std::size_t>& left, Packing& packing) {
  std::vector<StbRect> rects(left.size());
  for (std::size_t i = 0; i < left.size(); ++i)
    rects[i].size = scaled(sizes[left[i]], packing.places[left[i]].scale);
  pack_with_stb(texture, rects);
  std::vector<std::size_t> rest;
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (!rects[i].corner) {
      rest.push_back(left[i]);
      continue;
    }
    packing.places[left[i]].texture = index;
    packing.places[left[i]].corner = *rects[i].corner;
  }
  left = std::move(rest);
}

}  // namespace

cv::Size size_at(const Place& place, cv::Size size) {
  return scaled(size, place.scale);
}

Packing pack(std::span<const cv::Size> sizes, const PackingOptions& options) {
  const TextureSides sides(options);
  Packing packing;
  packing.places.resize(sizes.size());
  double area = 0;
  int longest = 1;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    Place& place = packing.places[i];
    place.scale = scale_to_fit(sizes[i], sides.max());
    if (place.scale < 1) ++packing.scaled_down;
    const cv::Size size = scaled(sizes[i], place.scale);
    area += static_cast<double>(size.width) * size.height;
    longest = std::max({longest, size.width, size.height});
  }
  std::vector<std::size_t> left(sizes.size());
  std::iota(left.begin(), left.end(), std::size_t{0});
  while (!left.empty()) {
    const auto index = static_cast<std::uint32_t>(packing.sizes.size());
    constexpr double kFilled = 0.9;
    const double side = std::min<double>(sides.max(), std::sqrt(area / kFilled));
    cv::Size texture;
    texture.width = texture.height = sides.at_least(std::max(longest, static_cast<int>(side) + 1));
    std::vector<std::size_t> rest = left;
    fill(texture, index, sizes, rest, packing);
    while (!rest.empty() && texture.width < sides.max()) {
      texture.width = texture.height = sides.after(texture.width);
      rest = left;
      fill(texture, index, sizes, rest, packing);
    }
    std::vector<bool> waits(sizes.size(), false);
    for (const std::size_t i : rest) waits[i] = true;
    int bottom = 1;
    for (const std::size_t i : left) {
      if (waits[i]) continue;
      const cv::Size size = size_at(packing.places[i], sizes[i]);
      bottom = std::max(bottom, packing.places[i].corner.y + size.height);
      area -= static_cast<double>(size.width) * size.height;
    }
    texture.height = sides.at_least(bottom);
    packing.sizes.push_back(texture);
    left = std::move(rest);
  }
  return packing;
}

}  // namespace axial::texture
