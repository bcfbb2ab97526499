// SPDX-License-Identifier: GPL-3.0-or-later
// Statistics of two images in windows of 7 x 7 pixels. The images are the picture of the reference
// view and the warped picture, which contains the source view's grey levels at the pixels of the
// reference view. Pixels without a warped grey level (NaN) do not count.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <opencv2/core.hpp>
#include <vector>

namespace axial::refine {

inline constexpr int kWindowRadius = 3;
inline constexpr int kBandHeight = 16;  // rows that one thread processes

// The sums over one window with `count` valid pixels. Let a be a grey level of the reference view
// minus kMiddle, and b the warped grey level minus kMiddle. The sums are r of a, w of b, rr of a^2,
// ww of b^2, and rw of a b. The subtraction keeps the sums small.
struct Windows {
  static constexpr float kMiddle = 128;
  // The variance of grey levels that comes from noise and rounding [grey levels^2].
  static constexpr float kNoise = 1.0f;
  // The least number of valid pixels, and the correlation that comparable() requires.
  static constexpr float kLeastPixels = 20;
  static constexpr float kLeastCorrelation = 0.3f;

  float count, r, w, rr, ww, rw;

  // Means [grey levels], variances and covariance [grey levels^2], and correlation (-1 to 1) of the
  // two images in the window. Without pixels they are NaN.
  float reference_mean() const { return r / count + kMiddle; }
  float warped_mean() const { return w / count + kMiddle; }
  float reference_variance() const { return rr / count - r / count * (r / count); }
  float warped_variance() const { return ww / count - w / count * (w / count); }
  float covariance() const { return rw / count - r / count * (w / count); }
  float correlation() const {
    return covariance() / std::sqrt(reference_variance() * warped_variance());
  }
  // Standard deviation of the reference view's grey levels / that of the warped grey levels.
  float gain() const { return std::sqrt(reference_variance() / warped_variance()); }
  // Whether the window has enough pixels, both images have texture in it, and they look alike.
  bool comparable() const {
    return count >= kLeastPixels && reference_variance() > kNoise / 4 &&
           warped_variance() > kNoise / 4 && correlation() > kLeastCorrelation;
  }
  // The inverse of the variance of the residuals in the window. A residual is a grey level of the
  // reference view minus gain() times the warped grey level, after both means are subtracted.
  float precision() const {
    return 1 / (2 * reference_variance() * std::max(0.0f, 1 - correlation()) + kNoise);
  }
};

// The number of bands of kBandHeight rows of an image with `rows` rows. The last band may have
// fewer rows.
inline std::size_t window_bands(int rows) {
  return static_cast<std::size_t>((rows + kBandHeight - 1) / kBandHeight);
}

// The six sums of Windows for each column, over the rows that have been added.
class ColumnSums {
 public:
  explicit ColumnSums(int width) : width_(width) {
    for (auto& channel : sum_) channel.resize(static_cast<std::size_t>(width + 2 * kWindowRadius));
  }

  // Adds a row of both images if `sign` is 1, and removes the row if `sign` is -1. Pixels whose
  // `warped` is NaN do not count.
  void add(const float* reference, const float* warped, float sign) {
    float *n = at(0), *r = at(1), *w = at(2), *rr = at(3), *ww = at(4), *rw = at(5);
    for (int x = 0; x < width_; ++x) {
      const bool valid = warped[x] == warped[x];
      const float a = valid ? reference[x] - Windows::kMiddle : 0.0f;
      const float b = valid ? warped[x] - Windows::kMiddle : 0.0f;
      n[x] += valid ? sign : 0.0f;
      r[x] += sign * a, w[x] += sign * b;
      rr[x] += sign * a * a, ww[x] += sign * b * b, rw[x] += sign * a * b;
    }
  }

  // The sums over the seven columns around x. Columns beyond the image add nothing.
  Windows window(int x) const {
    std::array<float, 6> total{};
    for (std::size_t c = 0; c < 6; ++c) {
      const float* from = sum_[c].data() + x;
      total[c] = ((from[0] + from[1]) + (from[2] + from[3])) + ((from[4] + from[5]) + from[6]);
    }
    return {total[0], total[1], total[2], total[3], total[4], total[5]};
  }

 private:
  static_assert(kWindowRadius == 3, "window() adds seven columns");
  float* at(std::size_t channel) { return sum_[channel].data() + kWindowRadius; }

  int width_;
  std::array<std::vector<float>, 6> sum_;
};

// Calls visit(x, y, windows) for every pixel of a band whose warped grey level is not NaN.
// `windows` are the sums over the window around (x, y), without pixels beyond the image. `band`:
// the index of the band, which begins at row band * kBandHeight. `reference` and `warped` have one
// size.
template <class Visit>
void for_each_window(const cv::Mat1f& reference, const cv::Mat1f& warped, std::size_t band,
                     Visit&& visit) {
  ColumnSums sums(warped.cols);
  const int first = static_cast<int>(band) * kBandHeight;
  const int last = std::min(first + kBandHeight, warped.rows);
  const auto add = [&](int y, float sign) {
    if (y >= 0 && y < warped.rows) sums.add(reference[y], warped[y], sign);
  };
  for (int y = first - kWindowRadius; y < first + kWindowRadius; ++y) add(y, 1);
  for (int y = first; y < last; ++y) {
    add(y + kWindowRadius, 1);
    for (int x = 0; x < warped.cols; ++x)
      if (warped(y, x) == warped(y, x)) visit(x, y, sums.window(x));
    add(y - kWindowRadius, -1);
  }
}

}  // namespace axial::refine
