// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibrate/saddles.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <optional>

namespace axial::calibrate {
namespace {

constexpr double kLeastContrast = 6;  // [grey levels]

// The negative determinant of the second derivatives: positive and large at a saddle.
cv::Mat1f saddle_strength(const cv::Mat1f& smooth) {
  cv::Mat1f strength(smooth.size(), 0.f);
  for (int y = 1; y + 1 < smooth.rows; ++y) {
    const float *above = smooth[y - 1], *here = smooth[y], *below = smooth[y + 1];
    for (int x = 1; x + 1 < smooth.cols; ++x) {
      const float xx = here[x + 1] + here[x - 1] - 2 * here[x];
      const float yy = below[x] + above[x] - 2 * here[x];
      const float xy = (below[x + 1] - below[x - 1] - above[x + 1] + above[x - 1]) / 4;
      strength(y, x) = xy * xy - xx * yy;
    }
  }
  return strength;
}

float value_at(const cv::Mat1f& image, double x, double y) {
  const int left = static_cast<int>(x), top = static_cast<int>(y);
  const auto right_share = static_cast<float>(x - left), low_share = static_cast<float>(y - top);
  const float *upper = image[top] + left, *lower = image[top + 1] + left;
  return (1 - low_share) * (upper[0] + right_share * (upper[1] - upper[0])) +
         low_share * (lower[0] + right_share * (lower[1] - lower[0]));
}

constexpr std::size_t kHalf = 16;  // samples of half a circle
using HalfCircle = std::array<double, kHalf>;

Eigen::Vector2d direction_of(double sample) {
  const double angle = sample * std::numbers::pi / kHalf;
  return {std::cos(angle), std::sin(angle)};
}

// The mean brightness of opposite samples of the circle around `at`. Empty if opposite samples
// differ too much: the surroundings of a saddle look the same after half a turn.
std::optional<HalfCircle> half_circle(const cv::Mat1f& smooth, cv::Point at) {
  HalfCircle means;
  double difference = 0;
  for (std::size_t k = 0; k < kHalf; ++k) {
    const Eigen::Vector2d step = kSaddleRadius * direction_of(static_cast<double>(k));
    const double one = value_at(smooth, at.x + step.x(), at.y + step.y());
    const double other = value_at(smooth, at.x - step.x(), at.y - step.y());
    means[k] = (one + other) / 2;
    difference += std::abs(one - other) / kHalf;
  }
  const auto [low, high] = std::ranges::minmax(means);
  constexpr double kMost = 0.35;
  if (high - low < kLeastContrast || difference > kMost * (high - low)) return {};
  return means;
}

// The places at which the brightness of a half circle crosses its middle value, upwards and
// downwards. Empty if there is not one of each.
std::optional<std::array<double, 2>> crossings(const HalfCircle& means) {
  const auto [low, high] = std::ranges::minmax(means);
  const double middle = (low + high) / 2;
  std::array<double, 2> places{};
  std::array<int, 2> counts{};
  for (std::size_t k = 0; k < kHalf; ++k) {
    const double here = means[k] - middle, next = means[(k + 1) % kHalf] - middle;
    if ((here < 0) == (next < 0)) continue;
    const std::size_t kind = here < 0 ? 0 : 1;
    places[kind] = static_cast<double>(k) + here / (here - next);
    ++counts[kind];
  }
  if (counts[0] != 1 || counts[1] != 1) return {};
  return places;
}

std::optional<Saddle> saddle_at(const cv::Mat1f& smooth, cv::Point at) {
  const auto means = half_circle(smooth, at);
  if (!means) return {};
  const auto places = crossings(*means);
  if (!places) return {};
  const auto [low, high] = std::ranges::minmax(*means);
  Saddle saddle{{at.x, at.y}, {direction_of((*places)[0]), direction_of((*places)[1])}, high - low};
  constexpr double kMostParallel = 0.92;  // cosine of the angle between the edges of a steep board
  if (std::abs(saddle.edges[0].dot(saddle.edges[1])) > kMostParallel) return {};
  return saddle;
}

}  // namespace

std::vector<Saddle> find_saddles(const cv::Mat1f& smooth, std::size_t most) {
  const cv::Mat1f strength = saddle_strength(smooth);
  cv::Mat1f largest;
  cv::dilate(strength, largest, cv::Mat1b::ones(5, 5));
  // Far below the strength of a blurred saddle with the least contrast.
  constexpr float kLeast = 0.01f;
  constexpr int kMargin = kSaddleRadius + 1;
  std::vector<Saddle> saddles;
  for (int y = kMargin; y + kMargin < smooth.rows; ++y)
    for (int x = kMargin; x + kMargin < smooth.cols; ++x) {
      if (strength(y, x) < kLeast || strength(y, x) < largest(y, x)) continue;
      if (const auto saddle = saddle_at(smooth, {x, y})) saddles.push_back(*saddle);
    }
  std::ranges::stable_sort(saddles, std::greater(), &Saddle::contrast);
  saddles.resize(std::min(saddles.size(), most));
  return saddles;
}

}  // namespace axial::calibrate
