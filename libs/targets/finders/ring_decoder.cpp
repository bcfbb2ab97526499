// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/finders/ring_decoder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace axial::targets {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr int kPerSegment = 12;  // samples along a segment

// Samples a picture at places relative to a dot.
class Sampler {
 public:
  Sampler(const cv::Mat1f& picture, const Ellipse& dot)
      : picture_(picture), centre_(dot.centre), from_circle_(dot.to_circle.inverse()) {}

  // True if the circle of `radius` radii of the dot lies in the picture.
  bool holds(double radius) const {
    const Eigen::Vector2d half =
        radius * (from_circle_ * from_circle_.transpose()).diagonal().cwiseSqrt();
    return (centre_ - half).minCoeff() >= 0 && centre_.x() + half.x() <= picture_.cols - 1 &&
           centre_.y() + half.y() <= picture_.rows - 1;
  }

  double at(double radius, double angle) const {
    const Eigen::Vector2d p =
        centre_ + radius * (from_circle_ * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    const int x = std::clamp(static_cast<int>(p.x()), 0, picture_.cols - 2);
    const int y = std::clamp(static_cast<int>(p.y()), 0, picture_.rows - 2);
    const double u = p.x() - x, v = p.y() - y;
    const auto pixel = [&](int i, int j) { return static_cast<double>(picture_(y + j, x + i)); };
    return (1 - v) * ((1 - u) * pixel(0, 0) + u * pixel(1, 0)) +
           v * ((1 - u) * pixel(0, 1) + u * pixel(1, 1));
  }

  double mean(double radius) const {
    constexpr int kDirections = 48;
    double sum = 0;
    for (int i = 0; i < kDirections; ++i) sum += at(radius, kTurn * i / kDirections);
    return sum / kDirections;
  }

 private:
  const cv::Mat1f& picture_;
  Eigen::Vector2d centre_;
  Eigen::Matrix2d from_circle_;
};

struct Levels {
  double white = 0, black = 0;  // brightness of the dot and of the gap
};

// Nothing unless the gap is dark all around.
std::optional<Levels> levels_of(const Sampler& sampler) {
  constexpr int kDirections = 16;
  Levels levels{sampler.mean(0.4), sampler.mean(1.5)};
  const double contrast = levels.white - levels.black;
  if (contrast <= 0) return std::nullopt;
  for (int i = 0; i < kDirections; ++i)
    if (sampler.at(1.5, kTurn * i / kDirections) > levels.black + 0.35 * contrast)
      return std::nullopt;
  return levels;
}

// The radii between which the mean over all directions is brighter than half of its largest value.
std::optional<RingRadii> radii_of(const Sampler& sampler, const Levels& levels) {
  constexpr double kFirst = 1.5, kLast = 3.8, kStep = 0.05;
  std::vector<double> profile;
  for (double radius = kFirst; radius < kLast; radius += kStep)
    profile.push_back(sampler.mean(radius) - levels.black);
  const auto top = std::ranges::max_element(profile);
  if (*top < 0.08 * (levels.white - levels.black)) return std::nullopt;
  auto inner = top, outer = top;
  while (inner != profile.begin() && *inner > *top / 2) --inner;
  while (outer != profile.end() && *outer > *top / 2) ++outer;
  const auto radius = [&](auto place) {
    return kFirst + kStep * static_cast<double>(place - profile.begin());
  };
  RingRadii radii{radius(inner) + kStep / 2, radius(outer) - kStep / 2};
  if (radii.inner < 1.55 || radii.inner > 2.45 || radii.outer < 2.4 || radii.outer > 3.7 ||
      radii.outer - radii.inner < 0.5)
    return std::nullopt;
  radii.plate = radii.outer + 1;
  return radii;
}

// The samples along the middle of the ring: 0 black, 1 white.
std::vector<double> ring_samples(const Sampler& sampler, const RingRadii& radii,
                                 const Levels& levels, int bits) {
  std::vector<double> samples(static_cast<std::size_t>(bits * kPerSegment));
  const double middle = (radii.inner + radii.outer) / 2, width = radii.outer - radii.inner;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double angle =
        kTurn * (static_cast<double>(i) + 0.5) / static_cast<double>(samples.size());
    double sum = 0;
    for (const double offset : {-0.2, 0.0, 0.2}) sum += sampler.at(middle + offset * width, angle);
    samples[i] = std::clamp((sum / 3 - levels.black) / (levels.white - levels.black), 0.0, 1.0);
  }
  return samples;
}

struct Segments {
  std::uint32_t value = 0;
  double clearness = 0;  // mean distance of the segments from grey, 0 to 1
};

// The segments, if the first begins at sample `phase`.
Segments segments_at(const std::vector<double>& samples, int phase, int bits) {
  Segments segments;
  for (int k = 0; k < bits; ++k) {
    double sum = 0;
    for (int i = 1; i < kPerSegment - 1; ++i)
      sum += samples[static_cast<std::size_t>(phase + k * kPerSegment + i) % samples.size()];
    const double mean = sum / (kPerSegment - 2);
    if (mean > 0.5) segments.value |= 1u << k;
    segments.clearness += std::abs(2 * mean - 1) / bits;
  }
  return segments;
}

}  // namespace

std::optional<RingReading> read_ring(const cv::Mat1f& picture, const Ellipse& dot, int bits) {
  const Sampler sampler(picture, dot);
  if (!sampler.holds(3.9)) return std::nullopt;
  const auto levels = levels_of(sampler);
  if (!levels) return std::nullopt;
  const auto radii = radii_of(sampler, *levels);
  if (!radii) return std::nullopt;
  const std::vector<double> samples = ring_samples(sampler, *radii, *levels, bits);
  Segments best;
  int best_phase = 0;
  for (int phase = 0; phase < kPerSegment; ++phase) {
    const Segments segments = segments_at(samples, phase, bits);
    if (segments.clearness > best.clearness) best = segments, best_phase = phase;
  }
  if (best.clearness < 0.3) return std::nullopt;
  return RingReading{best.value, kTurn * best_phase / (bits * kPerSegment), *radii};
}

}  // namespace axial::targets
