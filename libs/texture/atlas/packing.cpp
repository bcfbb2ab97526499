// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture/atlas/packing.h"

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
      : multiple_(options.multiple), max_(largest_side(options)) {
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

// The indices of rectangles in the order in which stb's packer takes them, after the first one.
std::vector<std::size_t> in_packing_order(std::span<const cv::Size> sizes) {
  std::vector<std::size_t> order(sizes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (order.empty()) return order;
  std::stable_sort(order.begin() + 1, order.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(sizes[a].height, sizes[a].width) > std::pair(sizes[b].height, sizes[b].width);
  });
  return order;
}

// Rectangles that were not tried yet: the places [first, end) of `order`.
struct Waiting {
  std::vector<std::size_t> order;
  std::size_t first, end;
};

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
    std::vector<cv::Size> sizes;
    for (std::size_t i = 0; i < sizes_.size(); ++i) sizes.push_back(size_of(i));
    Waiting waiting{in_packing_order(sizes), 0, sizes.size()};
    std::vector<std::size_t> tried;
    for (take_more(waiting, tried); !tried.empty(); take_more(waiting, tried))
      tried = fill_next(tried);
    return std::move(packing_);
  }

 private:
  cv::Size size_of(std::size_t i) const { return size_at(packing_.places[i], sizes_[i]); }

  double area_of(std::size_t i) const {
    const cv::Size size = size_of(i);
    return static_cast<double>(size.width) * size.height;
  }

  // Adds waiting rectangles, until `tried` could fill several textures: high ones, and low ones for
  // the gaps between them. If all rectangles were tried for each texture, the time would grow with
  // the square of their number.
  void take_more(Waiting& waiting, std::vector<std::size_t>& tried) const {
    constexpr double kHigh = 2, kAll = 16;  // [textures]
    const double texture = static_cast<double>(sides_.max()) * sides_.max();
    double area = 0;
    for (const std::size_t i : tried) area += area_of(i);
    const auto take = [&](std::size_t place) {
      tried.push_back(waiting.order[place]);
      area += area_of(tried.back());
    };
    while (waiting.first < waiting.end && area < kHigh * texture) take(waiting.first++);
    const auto middle = static_cast<std::ptrdiff_t>(tried.size());
    while (waiting.first < waiting.end && area < kAll * texture) take(--waiting.end);
    std::reverse(tried.begin() + middle, tried.end());
  }

  // Makes a texture for rectangles of `tried`. Returns those that remain.
  std::vector<std::size_t> fill_next(const std::vector<std::size_t>& tried) {
    constexpr double kFilled = 0.9;
    const double length = std::min<double>(sides_.max(), std::sqrt(area_ / kFilled));
    int side = sides_.at_least(std::max(longest_, static_cast<int>(length) + 1));
    std::vector<std::size_t> rest = fill(side, tried);
    while (!rest.empty() && side < sides_.max()) {
      side = sides_.after(side);
      rest = fill(side, tried);
    }
    cut(side, tried, rest);
    return rest;
  }

  // Places what fits of `tried` in a square texture. Returns what does not.
  std::vector<std::size_t> fill(int side, const std::vector<std::size_t>& tried) {
    std::vector<StbRect> rects(tried.size());
    for (std::size_t i = 0; i < tried.size(); ++i) rects[i].size = size_of(tried[i]);
    pack_with_stb({side, side}, rects);
    std::vector<std::size_t> rest;
    for (std::size_t i = 0; i < tried.size(); ++i) {
      if (!rects[i].corner) {
        rest.push_back(tried[i]);
        continue;
      }
      Place& place = packing_.places[tried[i]];
      place.texture = static_cast<std::uint32_t>(packing_.sizes.size());
      place.corner = *rects[i].corner;
    }
    return rest;
  }

  // Ends a texture with the rectangles of `tried` that are not in `rest`, both in the same order.
  void cut(int side, std::span<const std::size_t> tried, std::span<const std::size_t> rest) {
    int bottom = 1;
    auto left = rest.begin();
    for (const std::size_t i : tried) {
      if (left != rest.end() && *left == i) {
        ++left;
        continue;
      }
      bottom = std::max(bottom, packing_.places[i].corner.y + size_of(i).height);
      area_ -= area_of(i);
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

int largest_side(const PackingOptions& options) {
  if (options.max_size == 0) return kLargest;
  if (options.max_size < 16 || options.max_size > kLargest)
    fail("max_texture_size {}: must be 0 or from 16 to {}", options.max_size, kLargest);
  return options.max_size;
}

cv::Size size_at(const Place& place, cv::Size size) {
  return scaled(size, place.scale);
}

Packing pack(std::span<const cv::Size> sizes, const PackingOptions& options) {
  return Packer(sizes, options).pack();
}

}  // namespace axial::texture
