// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/noise.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/order_statistics.h"
#include "base/parallel.h"
#include "compare/height_map.h"

namespace axial::compare {
namespace {

constexpr int kReach = 4;  // of the pixels that the noise of a cell is measured against [px]
// The roughness of independent pixels, in their standard deviations: of a pixel and of the mean of
// four.
const double kRoughness = std::sqrt(1.25);
constexpr int kSquare = 16;  // side of the squares that show the correlation of pixels [px]

double level(const cv::Mat1f& difference, const cv::Mat1f& steepness, int y, int x) {
  return static_cast<double>(difference(y, x)) / static_cast<double>(steepness(y, x));
}

// The difference of a pixel from the mean of four pixels around it, on level ground. NaN if one of
// them is not compared.
double roughness(const cv::Mat1f& difference, const cv::Mat1f& steepness, int y, int x) {
  if (y < kReach || x < kReach || y + kReach >= difference.rows || x + kReach >= difference.cols)
    return std::numeric_limits<double>::quiet_NaN();
  const auto at = [&](int v, int u) { return static_cast<double>(difference(v, u)); };
  const double mean =
      (at(y - kReach, x) + at(y + kReach, x) + at(y, x - kReach) + at(y, x + kReach)) / 4;
  return (at(y, x) - mean) / static_cast<double>(steepness(y, x));
}

struct Spread {
  double middle = 0, sigma = 0;
};

// The spread of the values without outliers.
Spread robust_spread(std::vector<double> values) {
  Spread spread;
  for (std::size_t before = 0; before != values.size() && !values.empty();) {
    before = values.size();
    spread = {upper_median(values), robust_deviation(values)};
    std::erase_if(values,
                  [&](double value) { return std::abs(value - spread.middle) > 3 * spread.sigma; });
  }
  return spread;
}

// The mean of the level differences of a square, in standard deviations; NaN if less than half of
// its pixels are compared. `count` becomes the number of these pixels.
double mean_of_block(const cv::Mat1f& difference, const cv::Mat1f& steepness, const Noise& noise,
                     int top, int left, double& count) {
  double sum = 0;
  count = 0;
  for (int y = top; y < top + kSquare; ++y)
    for (int x = left; x < left + kSquare; ++x) {
      const double value = level(difference, steepness, y, x) / static_cast<double>(noise.at(y, x));
      if (!std::isnan(value)) sum += value, ++count;
    }
  return count < kSquare * kSquare / 2 ? std::numeric_limits<double>::quiet_NaN() : sum / count;
}

double correlation_of(const cv::Mat1f& difference, const cv::Mat1f& steepness, const Noise& noise) {
  constexpr std::size_t kLeastBlocks = 16;
  std::vector<double> means;
  double counts = 0, count = 0;
  for (int y = 0; y + kSquare <= difference.rows; y += kSquare)
    for (int x = 0; x + kSquare <= difference.cols; x += kSquare)
      if (const double mean = mean_of_block(difference, steepness, noise, y, x, count);
          !std::isnan(mean))
        means.push_back(mean), counts += count;
  if (means.size() < kLeastBlocks) return kSquare;  // between independent and equal pixels
  counts /= static_cast<double>(means.size());
  const double sigma = robust_spread(std::move(means)).sigma;
  return std::max(1.0, counts * sigma * sigma);
}

// The robust deviation of the roughness of the pixels of a cell; 0 if there are too few.
double roughness_of_cell(const cv::Mat1f& difference, const cv::Mat1f& steepness,
                         const cv::Rect& cell) {
  constexpr std::size_t kLeastPixels = 64;
  std::vector<double> values;
  for (int y = cell.y; y < cell.br().y; ++y)
    for (int x = cell.x; x < cell.br().x; ++x)
      if (const double value = roughness(difference, steepness, y, x); !std::isnan(value))
        values.push_back(value);
  return values.size() < kLeastPixels ? 0 : robust_deviation(std::move(values));
}

double roughness_of_map(const cv::Mat1f& difference, const cv::Mat1f& steepness) {
  return robust_spread(
             spread_values(difference.size(),
                           [&](int y, int x) { return roughness(difference, steepness, y, x); }))
      .sigma;
}

Noise uniform(const cv::Size& size, double sigma) {
  Noise noise;
  noise.typical = noise.lowest = noise.highest = sigma;
  const auto cells = [&](int pixels) { return (pixels + noise.cell - 1) / noise.cell; };
  noise.cells = cv::Mat1f(cells(size.height), cells(size.width), static_cast<float>(sigma));
  return noise;
}

}  // namespace

Noise estimate_noise(const cv::Mat1f& difference, const cv::Mat1f& steepness, double least) {
  const cv::Size size = difference.size();
  const double sigma = robust_spread(spread_values(size, [&](int y, int x) {
                         return level(difference, steepness, y, x);
                       })).sigma;
  const double rough = roughness_of_map(difference, steepness);
  Noise noise = uniform(size, std::max(sigma, least));
  noise.local = rough / kRoughness;
  const double scale = rough > 0 ? sigma / rough : 0;
  const auto across = static_cast<std::size_t>(noise.cells.cols);
  parallel_for(noise.cells.total(), [&](std::size_t c) {
    const auto y = static_cast<int>(c / across), x = static_cast<int>(c % across);
    const cv::Rect cell(x * noise.cell, y * noise.cell, noise.cell, noise.cell);
    const double found =
        scale * roughness_of_cell(difference, steepness, cell & cv::Rect({}, size));
    if (found > 0)
      noise.cells(y, x) =
          static_cast<float>(std::clamp(found, 0.5 * noise.typical, 4 * noise.typical));
  });
  cv::minMaxLoc(noise.cells, &noise.lowest, &noise.highest);
  noise.correlation = correlation_of(difference, steepness, noise);
  return noise;
}

Noise given_noise(const cv::Mat1f& difference, const cv::Mat1f& steepness, double sigma) {
  Noise noise = uniform(difference.size(), sigma);
  noise.is_given = true;
  noise.local = roughness_of_map(difference, steepness) / kRoughness;
  noise.correlation = correlation_of(difference, steepness, noise);
  return noise;
}

}  // namespace axial::compare
