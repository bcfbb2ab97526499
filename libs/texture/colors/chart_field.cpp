// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture/colors/chart_field.h"

#include <array>
#include <cmath>

#include "base/plane_cross.h"

namespace axial::texture {
namespace {

cv::Vec3f as_pixel(const Eigen::Vector3f& v) {
  return {v[0], v[1], v[2]};
}

constexpr std::array<std::array<int, 2>, 4> kBeside{{{0, -1}, {-1, 0}, {1, 0}, {0, 1}}};

// The pixels of a strip, in the order of their distance from its beginning, with their equations.
class Strip {
 public:
  Strip(const cv::Mat1b& covered, int width)
      : covered_(covered), width_(width), id_(covered.size(), -1) {}

  void start(std::span<const ChartField::Sample> samples) {
    std::vector<int> counts;
    for (const ChartField::Sample& sample : samples) {
      const cv::Point at(static_cast<int>(std::lround(sample.at.x())),
                         static_cast<int>(std::lround(sample.at.y())));
      if (!contains(at)) continue;
      if (id_(at) < 0) take(at, {0, 0, 0}), counts.push_back(0);
      const auto i = static_cast<std::size_t>(id_(at));
      value_[i] += as_pixel(sample.value);
      ++counts[i];
    }
    for (std::size_t i = 0; i < counts.size(); ++i) value_[i] *= 1 / static_cast<float>(counts[i]);
    fixed_ = pixels_.size();
  }

  // Adds one ring of pixels after the other. The value of a ring begins with the solution for a
  // straight seam, which falls linearly.
  void grow() {
    std::size_t ring = 0;
    for (int d = 1; d < width_; ++d) {
      const std::size_t end = pixels_.size();
      const float fall = static_cast<float>(width_ - d) / static_cast<float>(width_ - d + 1);
      for (std::size_t i = ring; i < end; ++i)
        for (const auto& [dx, dy] : kBeside) {
          const cv::Point at(pixels_[i].x + dx, pixels_[i].y + dy);
          if (contains(at) && id_(at) < 0) take(at, value_[i] * fall);
        }
      ring = end;
    }
  }

  // Gauss and Seidel's iteration with overrelaxation.
  void relax(int iterations, float factor) {
    for (int k = 0; k < iterations; ++k)
      for (std::size_t i = fixed_; i < pixels_.size(); ++i) {
        cv::Vec3f sum(0, 0, 0);
        int count = 0;
        for (const auto& [dx, dy] : kBeside) {
          const cv::Point at(pixels_[i].x + dx, pixels_[i].y + dy);
          if (!contains(at)) continue;
          ++count;
          if (id_(at) >= 0) sum += value_[static_cast<std::size_t>(id_(at))];
        }
        if (count > 0) value_[i] += (sum * (1 / static_cast<float>(count)) - value_[i]) * factor;
      }
  }

  void add_to(cv::Mat3f& field) const {
    for (std::size_t i = 0; i < pixels_.size(); ++i) field(pixels_[i]) += value_[i];
  }

 private:
  bool contains(const cv::Point& at) const {
    return at.x >= 0 && at.y >= 0 && at.x < covered_.cols && at.y < covered_.rows && covered_(at);
  }
  void take(const cv::Point& at, const cv::Vec3f& value) {
    id_(at) = static_cast<int>(pixels_.size());
    pixels_.push_back(at);
    value_.push_back(value);
  }

  const cv::Mat1b& covered_;
  int width_;
  cv::Mat1i id_;  // index into pixels_; -1: not in the strip
  std::vector<cv::Point> pixels_;
  std::vector<cv::Vec3f> value_;
  std::size_t fixed_ = 0;  // the first pixels, at the seam
};

}  // namespace

std::uint64_t bytes_of_field(std::uint64_t pixels) {
  // The field, and of a strip the index of each pixel and the lists, which grow.
  return pixels *
         (1 + sizeof(cv::Vec3f) + sizeof(int) + 2 * (sizeof(cv::Point) + sizeof(cv::Vec3f)));
}

void ChartField::add_triangle(const std::array<Eigen::Vector2f, 3>& corners,
                              const std::array<Eigen::Vector3f, 3>& values) {
  const float area = plane_cross(corners[1] - corners[0], corners[2] - corners[0]);
  if (area == 0) return;
  const Eigen::Vector2f low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
  const Eigen::Vector2f high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
  const int x0 = std::max(0, static_cast<int>(std::ceil(low.x())));
  const int y0 = std::max(0, static_cast<int>(std::ceil(low.y())));
  const int x1 = std::min(covered_.cols - 1, static_cast<int>(std::floor(high.x())));
  const int y1 = std::min(covered_.rows - 1, static_cast<int>(std::floor(high.y())));
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) {
      if (covered_(y, x)) continue;
      const Eigen::Vector2f p(static_cast<float>(x), static_cast<float>(y));
      const float s = plane_cross(p - corners[0], corners[2] - corners[0]) / area;
      const float t = plane_cross(corners[1] - corners[0], p - corners[0]) / area;
      constexpr float kRounding = -1e-4f;
      if (s < kRounding || t < kRounding || 1 - s - t < kRounding) continue;
      covered_(y, x) = 1;
      value_(y, x) = as_pixel((1 - s - t) * values[0] + s * values[1] + t * values[2]);
    }
}

void ChartField::add_point(const Eigen::Vector2f& at, const Eigen::Vector3f& value) {
  const int x = static_cast<int>(std::floor(at.x())), y = static_cast<int>(std::floor(at.y()));
  for (int j = std::max(0, y); j <= std::min(covered_.rows - 1, y + 1); ++j)
    for (int i = std::max(0, x); i <= std::min(covered_.cols - 1, x + 1); ++i) {
      if (covered_(j, i)) continue;
      covered_(j, i) = 1;
      value_(j, i) = as_pixel(value);
    }
}

void ChartField::widen() {
  const cv::Mat1b before = covered_.clone();
  for (int y = 0; y < before.rows; ++y)
    for (int x = 0; x < before.cols; ++x) {
      if (before(y, x)) continue;
      cv::Vec3f sum(0, 0, 0);
      int count = 0;
      for (int j = std::max(0, y - 1); j <= std::min(before.rows - 1, y + 1); ++j)
        for (int i = std::max(0, x - 1); i <= std::min(before.cols - 1, x + 1); ++i)
          if (before(j, i)) sum += value_(j, i), ++count;
      if (count == 0) continue;
      covered_(y, x) = 1;
      value_(y, x) = sum * (1 / static_cast<float>(count));
    }
}

void ChartField::add_strip(std::span<const Sample> samples, int width) {
  if (samples.empty()) return;
  Strip strip(covered_, width);
  strip.start(samples);
  strip.grow();
  constexpr int kIterations = 20;
  constexpr float kFactor = 1.6f;
  strip.relax(kIterations, kFactor);
  strip.add_to(value_);
}

void ChartField::add_to(cv::Mat3b texture) const {
  for (int y = 0; y < covered_.rows; ++y)
    for (int x = 0; x < covered_.cols; ++x) {
      if (!covered_(y, x)) continue;
      cv::Vec3b& pixel = texture(y, x);
      for (int c = 0; c < 3; ++c)
        pixel[c] = cv::saturate_cast<std::uint8_t>(static_cast<float>(pixel[c]) + value_(y, x)[c]);
    }
}

}  // namespace axial::texture
