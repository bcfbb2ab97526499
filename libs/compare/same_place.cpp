// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/same_place.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "base/order_statistics.h"
#include "base/pair_sums.h"
#include "base/parallel.h"
#include "compare/height_map.h"

namespace axial::compare {
namespace {

constexpr int kCells = 60;             // along the longer side, at most
constexpr double kAround = 0.07;       // of the longer side: the mean height around
constexpr int kWindow = 6, kStep = 3;  // side of a window, and distance of the windows [cells]
constexpr int kShifts = 12;            // along each side of the map
constexpr std::size_t kFewest = 12;    // windows
constexpr double kSame = 0.6, kOfRelief = 2.5, kLeastRelief = 0.2;

// A map of cells, each of which is the mean of the heights in a square; NaN where less than half of
// the square has a height.
cv::Mat1f reduced(const cv::Mat1f& heights) {
  const int step = std::max(1, (std::max(heights.cols, heights.rows) + kCells - 1) / kCells);
  cv::Mat1f result((heights.rows + step - 1) / step, (heights.cols + step - 1) / step,
                   std::numeric_limits<float>::quiet_NaN());
  for (int y = 0; y < result.rows; ++y)
    for (int x = 0; x < result.cols; ++x) {
      double sum = 0;
      int count = 0;
      for (int v = y * step; v < std::min((y + 1) * step, heights.rows); ++v)
        for (int u = x * step; u < std::min((x + 1) * step, heights.cols); ++u)
          if (!std::isnan(heights(v, u))) {
            sum += static_cast<double>(heights(v, u));
            ++count;
          }
      if (2 * count >= step * step) result(y, x) = static_cast<float>(sum / count);
    }
  return result;
}

// The height minus the mean height around, cut off. NaN stays NaN.
cv::Mat1f relief_of(const cv::Mat1f& heights) {
  cv::Mat1f known(heights.size(), 0.f), values(heights.size(), 0.f);
  for (int y = 0; y < heights.rows; ++y)
    for (int x = 0; x < heights.cols; ++x)
      if (!std::isnan(heights(y, x))) {
        known(y, x) = 1;
        values(y, x) = heights(y, x);
      }
  const int side = 2 * static_cast<int>(kAround * std::max(heights.cols, heights.rows) / 2) + 1;
  cv::Mat1f sums, counts;
  cv::boxFilter(values, sums, CV_32F, {side, side}, {-1, -1}, false, cv::BORDER_CONSTANT);
  cv::boxFilter(known, counts, CV_32F, {side, side}, {-1, -1}, false, cv::BORDER_CONSTANT);
  cv::Mat1f relief = heights.clone();
  std::vector<double> all;
  for (int y = 0; y < heights.rows; ++y)
    for (int x = 0; x < heights.cols; ++x)
      if (!std::isnan(heights(y, x))) {
        relief(y, x) -= sums(y, x) / counts(y, x);
        all.push_back(static_cast<double>(relief(y, x)));
      }
  const auto most = static_cast<float>(3 * robust_deviation(std::move(all)));
  for (float& value : relief)
    if (!std::isnan(value)) value = std::clamp(value, -most, most);
  return relief;
}

// The sums over a window of `a` and of `b` shifted by (dx, dy). The parts of `b` that are shifted
// beyond a side come in at the other side.
PairSums sums_in(const cv::Mat1f& a, const cv::Mat1f& b, cv::Point shift, cv::Rect window) {
  PairSums sums;
  for (int y = window.y; y < window.br().y; ++y)
    for (int x = window.x; x < window.br().x; ++x) {
      const auto p = static_cast<double>(a(y, x));
      const auto q = static_cast<double>(b((y + shift.y) % a.rows, (x + shift.x) % a.cols));
      if (!std::isnan(p) && !std::isnan(q)) sums.add(p, q);
    }
  return sums;
}

struct Correlation {
  double value = 0;         // median of the windows
  std::size_t windows = 0;  // of which at least half of the cells have both heights
};

// The correlation of `a` with `b` shifted as in sums_in().
Correlation correlation(const cv::Mat1f& a, const cv::Mat1f& b, cv::Point shift) {
  std::vector<double> values;
  for (int y = 0; y + kWindow <= a.rows; y += kStep)
    for (int x = 0; x + kWindow <= a.cols; x += kStep) {
      const PairSums sums = sums_in(a, b, shift, {x, y, kWindow, kWindow});
      if (2 * sums.n >= kWindow * kWindow) values.push_back(sums.correlation());
    }
  const std::size_t windows = values.size();
  return {upper_median(std::move(values)), windows};
}

// The correlation of a relief with itself one cell away; at least 0.
double correlation_with_itself(const cv::Mat1f& relief) {
  return std::max(0.0, std::min(correlation(relief, relief, {1, 0}).value,
                                correlation(relief, relief, {0, 1}).value));
}

PlaceVerdict verdict_of(const PlaceAgreement& agreement) {
  if (agreement.correlation >= kSame) return PlaceVerdict::same;
  if (agreement.relief < kLeastRelief) return PlaceVerdict::unknown;
  return agreement.correlation >= agreement.least ? PlaceVerdict::same : PlaceVerdict::different;
}

// The correlations of `a` with the shifted, turned and mirrored `b`.
std::vector<double> chances(const cv::Mat1f& a, const cv::Mat1f& b, std::size_t least) {
  std::vector<double> values;
  for (int way = 0; way < 4; ++way) {
    cv::Mat1f other = b;
    if (way > 0) cv::flip(b, other, way - 2);  // around both axes, or one of them
    std::vector<Correlation> found(kShifts * kShifts);
    parallel_for(found.size(), [&](std::size_t k) {
      const int dx = static_cast<int>(k) % kShifts * a.cols / kShifts;
      const int dy = static_cast<int>(k) / kShifts * a.rows / kShifts;
      if (way > 0 || k > 0) found[k] = correlation(a, other, {dx, dy});
    });
    for (const Correlation& one : found)
      if (one.windows >= least) values.push_back(one.value);
  }
  return values;
}

}  // namespace

PlaceAgreement agreement_of_places(const cv::Mat1f& before, const cv::Mat1f& after) {
  cv::Mat1f a = reduced(before), b = reduced(after);
  // Relief is what both surveys have: what surrounds one of them alone must not count.
  for (int y = 0; y < a.rows; ++y)
    for (int x = 0; x < a.cols; ++x)
      if (std::isnan(a(y, x)) || std::isnan(b(y, x)))
        a(y, x) = b(y, x) = std::numeric_limits<float>::quiet_NaN();
  a = relief_of(a);
  b = relief_of(b);
  PlaceAgreement result;
  const Correlation here = correlation(a, b, {0, 0});
  if (here.windows < kFewest) return result;
  std::vector<double> by_chance = chances(a, b, here.windows / 4);
  if (by_chance.size() < 100) return result;
  std::ranges::sort(by_chance);
  result.correlation = here.value;
  result.chance = by_chance[by_chance.size() * 99 / 100];
  result.relief = std::sqrt(correlation_with_itself(a) * correlation_with_itself(b));
  result.least = std::min(kSame, kOfRelief * result.relief);
  result.verdict = verdict_of(result);
  return result;
}

}  // namespace axial::compare
