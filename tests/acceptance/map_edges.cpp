// SPDX-License-Identifier: GPL-3.0-or-later
#include "map_edges.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace axial::map_check {
namespace {

constexpr int kReach = 12;                      // [px]
constexpr float kStep = 0.5f;                   // between samples [px]
constexpr int kSamples = 26;                    // to both sides, 1 px beyond kReach
constexpr int kLeastWrong = 6;                  // samples
constexpr float kLeastStep = 0.05f;             // of the heights [m]
constexpr float kLeastContrast = 6;             // [levels/px]
constexpr float kCounted = 0.6f, kTrue = 0.2f;  // relative to the largest edge
constexpr float kNear = 2;                      // [px]

cv::Mat1f smooth_grey(const cv::Mat3b& map) {
  cv::Mat grey;
  cv::cvtColor(map, grey, cv::COLOR_RGB2GRAY);
  cv::Mat1f result;
  grey.convertTo(result, CV_32F);
  cv::GaussianBlur(result, result, {}, 1.5);
  return result;
}

float value_at(const cv::Mat1f& map, const cv::Point2f& at) {
  const int x = static_cast<int>(at.x), y = static_cast<int>(at.y);
  const float s = at.x - static_cast<float>(x), t = at.y - static_cast<float>(y);
  return (1 - t) * ((1 - s) * map(y, x) + s * map(y, x + 1)) +
         t * ((1 - s) * map(y + 1, x) + s * map(y + 1, x + 1));
}

struct Peak {
  float gradient, place;  // absolute [levels/px]; along the line from its middle [px]
};

// The maxima of the gradient along a line, the largest first.
std::vector<Peak> peaks_of(const cv::Mat1f& grey, const Crossing& crossing) {
  std::vector<float> gradients;
  const int count = static_cast<int>(2 * kReach / kStep);
  for (int i = 0; i < count; ++i) {
    const float along = (static_cast<float>(i) + 0.5f) * kStep - kReach;
    const float before = value_at(grey, crossing.middle + (along - 0.5f) * crossing.direction);
    const float after = value_at(grey, crossing.middle + (along + 0.5f) * crossing.direction);
    gradients.push_back(std::abs(after - before));
  }
  std::vector<Peak> peaks;
  for (std::size_t i = 1; i + 1 < gradients.size(); ++i)
    if (gradients[i] >= gradients[i - 1] && gradients[i] > gradients[i + 1])
      peaks.push_back({gradients[i], (static_cast<float>(i) + 0.5f) * kStep - kReach});
  std::ranges::sort(peaks, std::greater(), &Peak::gradient);
  return peaks;
}

bool has_peak(const std::vector<Peak>& peaks, float place, float least) {
  return std::ranges::any_of(peaks, [&](const Peak& peak) {
    return peak.gradient > least && std::abs(peak.place - place) <= kNear;
  });
}

// The direction of the steepest height at a depth step; 0 elsewhere, and beside missing surface.
cv::Point2f direction_at(const cv::Mat1f& heights, int x, int y) {
  const float dx = heights(y, x + 1) - heights(y, x - 1),
              dy = heights(y + 1, x) - heights(y - 1, x);
  const float steepness = std::hypot(dx, dy);
  if (!(steepness > 2 * kLeastStep)) return {0, 0};
  return {dx / steepness, dy / steepness};
}

// The samples of a line, at steps of kStep, whose pixel is not 0.
int samples_in(const cv::Mat1b& pixels, const Crossing& crossing) {
  int count = 0;
  for (int i = -kSamples; i <= kSamples; ++i) {
    const cv::Point2f at = crossing.middle + static_cast<float>(i) * kStep * crossing.direction;
    count += pixels(static_cast<int>(at.y + 0.5f), static_cast<int>(at.x + 0.5f)) != 0;
  }
  return count;
}

}  // namespace

std::vector<Crossing> depth_steps(const TrueMap& truth, const cv::Mat1b& usable,
                                  const cv::Mat1b& wrong) {
  std::vector<Crossing> crossings;
  constexpr int kBorder = kReach + 3;
  for (int y = kBorder; y < usable.rows - kBorder; ++y)
    for (int x = kBorder; x < usable.cols - kBorder; ++x) {
      const Crossing crossing{cv::Point2f(cv::Point(x, y)), direction_at(truth.heights, x, y)};
      if (crossing.direction != cv::Point2f(0, 0) &&
          samples_in(usable, crossing) == 2 * kSamples + 1 &&
          samples_in(wrong, crossing) >= kLeastWrong)
        crossings.push_back(crossing);
    }
  return crossings;
}

EdgeCounts count_edges(const cv::Mat3b& map, const cv::Mat3b& true_map,
                       const std::vector<Crossing>& crossings) {
  const cv::Mat1f grey = smooth_grey(map), true_grey = smooth_grey(true_map);
  EdgeCounts counts;
  for (const Crossing& crossing : crossings) {
    const std::vector<Peak> truth = peaks_of(true_grey, crossing), seen = peaks_of(grey, crossing);
    if (truth.empty() || truth[0].gradient < kLeastContrast) continue;
    ++counts.lines;
    const float counted = seen.empty() ? 0 : kCounted * seen[0].gradient;
    // Otherwise the edge is displaced.
    if (!has_peak(seen, truth[0].place, counted)) continue;
    counts.doubled += std::ranges::any_of(seen, [&](const Peak& peak) {
      return peak.gradient > counted && !has_peak(truth, peak.place, kTrue * truth[0].gradient);
    });
  }
  return counts;
}

cv::Mat3b doubled(const cv::Mat3b& map, int dx, int dy) {
  cv::Mat3b moved = map.clone(), mean;
  const cv::Rect from(0, 0, map.cols - dx, map.rows - dy), to(dx, dy, from.width, from.height);
  map(from).copyTo(moved(to));
  cv::addWeighted(map, 0.5, moved, 0.5, 0, mean);
  return mean;
}

}  // namespace axial::map_check
