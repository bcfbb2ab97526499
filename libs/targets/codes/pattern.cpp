// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/codes/pattern.h"

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "targets/codes/dictionary.h"

namespace axial::targets {
namespace {

void check_number(const Family& family, std::size_t number) {
  const Numbers numbers = numbers_of(family);
  if (number < numbers.first || number > numbers.last)
    fail("{} {}: the targets are numbered from {} to {}", family.name, number, numbers.first,
         numbers.last);
}

cv::Mat1b cells_of(const Family& family, std::size_t number) {
  const auto markers = dictionary(family.dictionary);
  cv::Mat1b cells;
  markers->drawMarker(static_cast<int>(number), markers->markerSize + 2, cells, 1);
  return cells;
}

}  // namespace

Pattern::Pattern(std::uint32_t code, int bits, const RingRadii& radii)
    : code_(code), bits_(bits), radii_(radii), half_plate_(radii.plate) {}

Pattern::Pattern(const Family& family, std::size_t number, const RingRadii& radii)
    : bits_(family.bits), radii_(radii), half_plate_(radii.plate) {
  check_number(family, number);
  code_ = static_cast<std::uint32_t>(code_of(family, number));
  if (family.kind == Kind::ring) return;
  cells_ = cells_of(family, number);
  half_plate_ = half_marker() + 1;
}

bool Pattern::white(double x, double y) const {
  const bool on_plate = std::abs(x) <= half_plate_ && std::abs(y) <= half_plate_;
  if (!on_plate) return !cells_.empty();  // also for a place that is not a number
  if (!cells_.empty()) {
    const int column = static_cast<int>(std::floor(x + half_marker()));
    const int row = static_cast<int>(std::floor(y + half_marker()));
    const cv::Rect marker(0, 0, cells_.cols, cells_.rows);
    return !marker.contains({column, row}) || cells_(row, column) != 0;
  }
  const double radius = std::hypot(x, y);
  if (radius < 1) return true;
  if (radius < radii_.inner || radius > radii_.outer) return false;
  constexpr double kTurn = 2 * std::numbers::pi;
  const double turn = std::atan2(y, x) / kTurn;
  const int segment = static_cast<int>((turn < 0 ? turn + 1 : turn) * bits_) % bits_;
  return (code_ >> segment) & 1u;
}

cv::Mat1b draw_plate(const Pattern& pattern, int side) {
  constexpr int kSamples = 8;  // along each side of a pixel
  cv::Mat1b picture(side, side);
  const double step = 2 * pattern.half_plate() / (side * kSamples);
  const auto place = [&](int sample) { return (sample + 0.5) * step - pattern.half_plate(); };
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      int white = 0;
      for (int i = 0; i < kSamples * kSamples; ++i)
        white +=
            pattern.white(place(x * kSamples + i % kSamples), place(y * kSamples + i / kSamples));
      picture(y, x) = static_cast<std::uint8_t>(white * 255 / (kSamples * kSamples));
    }
  return picture;
}

}  // namespace axial::targets
