// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/depth_evaluation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/order_statistics.h"
#include "base/parallel.h"

namespace axial::evaluate {
namespace {

constexpr float kEdge = 1.05f;  // ratio of neighbouring distances that counts as an edge

bool is_distance(float value) {
  return value > 0 && std::isfinite(value);
}

float read_off(const cv::Mat1f& truth, double u, double v) {
  const int last_x = truth.cols - 1, last_y = truth.rows - 1;
  const double x = std::clamp(u, 0.0, static_cast<double>(last_x));
  const double y = std::clamp(v, 0.0, static_cast<double>(last_y));
  const float nearest = truth(static_cast<int>(std::lround(y)), static_cast<int>(std::lround(x)));
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const int x1 = std::min(x0 + 1, last_x), y1 = std::min(y0 + 1, last_y);
  const std::array<float, 4> d{truth(y0, x0), truth(y0, x1), truth(y1, x0), truth(y1, x1)};
  const auto [low, high] = std::minmax_element(d.begin(), d.end());
  if (!std::all_of(d.begin(), d.end(), is_distance) || *high > kEdge * *low)
    return is_distance(nearest) ? nearest : 0.0f;
  const double fx = x - x0, fy = y - y0;
  const auto inverse = [&](std::size_t k) { return 1.0 / static_cast<double>(d[k]); };
  return static_cast<float>(1.0 / ((1 - fy) * ((1 - fx) * inverse(0) + fx * inverse(1)) +
                                   fy * ((1 - fx) * inverse(2) + fx * inverse(3))));
}

void check(const cv::Mat1f& estimate, const cv::Mat1f& truth, const DepthOptions& options) {
  if (estimate.empty()) fail("the depth map has no pixels");
  if (truth.empty()) fail("the true distance map has no pixels");
  const double expected = static_cast<double>(truth.rows) * estimate.cols / truth.cols;
  if (std::abs(expected - estimate.rows) > 1)
    fail("the depth map is {} x {}, the truth {} x {}: not the same shape", estimate.cols,
         estimate.rows, truth.cols, truth.rows);
  if (options.tolerances.empty()) fail("no tolerance is given");
  for (const double tolerance : options.tolerances)
    if (!(tolerance > 0) || !std::isfinite(tolerance))
      fail("tolerance is {}: it must be a positive length in metres", tolerance);
}

// Divides an image into `count` rings of equal width from the centre to the corners.
class Rings {
 public:
  Rings(cv::Size size, std::size_t count)
      : cx_((size.width - 1) / 2.0),
        cy_((size.height - 1) / 2.0),
        half_diagonal_(std::hypot(size.width, size.height) / 2),
        count_(count) {}

  std::size_t of(int u, int v) const {
    const double radius = std::hypot(u - cx_, v - cy_) / half_diagonal_;
    return std::min(static_cast<std::size_t>(radius * static_cast<double>(count_)), count_ - 1);
  }
  double inner(std::size_t k) const { return static_cast<double>(k) / static_cast<double>(count_); }

 private:
  double cx_, cy_, half_diagonal_;
  std::size_t count_;
};

std::vector<Ring> rings_of(const cv::Mat1f& error, std::size_t count) {
  std::vector<std::vector<float>> values(count), magnitudes(count);
  const Rings rings(error.size(), count);
  for (int v = 0; v < error.rows; ++v)
    for (int u = 0; u < error.cols; ++u) {
      if (std::isnan(error(v, u))) continue;
      const std::size_t k = rings.of(u, v);
      values[k].push_back(error(v, u));
      magnitudes[k].push_back(std::abs(error(v, u)));
    }
  std::vector<Ring> result(count);
  for (std::size_t k = 0; k < count; ++k)
    result[k] = {rings.inner(k), rings.inner(k + 1), values[k].size(), mean_median(values[k]),
                 mean_median(magnitudes[k])};
  return result;
}

}  // namespace

cv::Mat1f resample_distance(const cv::Mat1f& truth, cv::Size size) {
  if (truth.size() == size) return truth.clone();
  cv::Mat1f result(size);
  const double sx = static_cast<double>(truth.cols) / size.width;
  const double sy = static_cast<double>(truth.rows) / size.height;
  parallel_for(static_cast<std::size_t>(size.height), [&](std::size_t row) {
    const int v = static_cast<int>(row);
    for (int u = 0; u < size.width; ++u)
      result(v, u) = read_off(truth, (u + 0.5) * sx - 0.5, (v + 0.5) * sy - 0.5);
  });
  return result;
}

DepthEvaluation evaluate_depth(const cv::Mat1f& estimate, const cv::Mat1f& truth,
                               const DepthOptions& options) {
  check(estimate, truth, options);
  DepthEvaluation result;
  result.truth = resample_distance(truth, estimate.size());
  result.error = cv::Mat1f(estimate.size(), std::numeric_limits<float>::quiet_NaN());
  std::vector<float> errors, magnitudes;
  double sum = 0;
  for (int v = 0; v < estimate.rows; ++v)
    for (int u = 0; u < estimate.cols; ++u) {
      const bool known = is_distance(result.truth(v, u));
      const bool found = is_distance(estimate(v, u));
      if (!known) result.truth(v, u) = 0;
      result.truth_pixels += known;
      result.estimated_pixels += found;
      if (!known || !found) continue;
      const float error = estimate(v, u) - result.truth(v, u);
      result.error(v, u) = error;
      errors.push_back(error);
      magnitudes.push_back(std::abs(error));
      sum += static_cast<double>(error);
    }
  if (errors.empty()) fail("the depth map and the truth have no pixel in common");
  result.compared_pixels = errors.size();
  result.completeness =
      static_cast<double>(errors.size()) / static_cast<double>(result.truth_pixels);
  result.signed_mean = sum / static_cast<double>(errors.size());
  result.signed_median = mean_median(std::move(errors));
  result.accuracy = summarise(magnitudes);
  result.accuracy_histogram =
      histogram(magnitudes, 4 * options.tolerances.front(), options.histogram_bins);
  for (const double tolerance : options.tolerances) {
    const double precision = score(magnitudes, {}, tolerance).precision;
    result.scores.push_back(score_of(tolerance, precision, precision * result.completeness));
  }
  result.rings = rings_of(result.error, options.rings);
  return result;
}

std::vector<RelativeRing> relative_rings(std::span<const DepthEvaluation> maps, std::size_t count) {
  std::vector<std::vector<float>> values(count);
  std::vector<RelativeRing> result(count);
  for (const DepthEvaluation& map : maps) {
    const Rings rings(map.error.size(), count);
    for (int v = 0; v < map.error.rows; ++v)
      for (int u = 0; u < map.error.cols; ++u)
        if (!std::isnan(map.error(v, u)))
          values[rings.of(u, v)].push_back(map.error(v, u) / map.truth(v, u));
  }
  for (std::size_t k = 0; k < count; ++k)
    result[k] = {static_cast<double>(k) / static_cast<double>(count),
                 static_cast<double>(k + 1) / static_cast<double>(count), values[k].size(),
                 mean_median(std::move(values[k]))};
  return result;
}

}  // namespace axial::evaluate
