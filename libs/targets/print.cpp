// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/print.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "targets/codes/pattern.h"

namespace axial::targets {
namespace {

constexpr double kMargin = 10, kText = 5;  // around the plates, height of the text [mm]

// An SVG path of the segments of a ring, as white areas. Neighbouring segments touch.
std::string ring_path(const Pattern& pattern, int bits) {
  const auto point = [](double radius, double angle) {
    return fmt::format("{:.5f} {:.5f}", radius * std::cos(angle), radius * std::sin(angle));
  };
  const RingRadii radii;
  std::string path;
  for (int k = 0; k < bits; ++k) {
    const double begin = 2 * std::numbers::pi * k / bits;
    const double end = 2 * std::numbers::pi * (k + 1) / bits, middle = (begin + end) / 2;
    const double radius = (radii.inner + radii.outer) / 2;
    if (!pattern.white(radius * std::cos(middle), radius * std::sin(middle))) continue;
    path += fmt::format("M{} A{} {} 0 0 1 {} L{} A{} {} 0 0 0 {} Z", point(radii.inner, begin),
                        radii.inner, radii.inner, point(radii.inner, end), point(radii.outer, end),
                        radii.outer, radii.outer, point(radii.outer, begin));
  }
  return path;
}

std::string ring_elements(const Pattern& pattern, int bits) {
  const double half = pattern.half_plate();
  return fmt::format(
      "<rect x=\"{0}\" y=\"{0}\" width=\"{1}\" height=\"{1}\"/>"
      "<circle r=\"1\" fill=\"white\"/><path d=\"{2}\" fill=\"white\"/>",
      -half, 2 * half, ring_path(pattern, bits));
}

// The black cells, row by row; cells side by side are one rectangle.
std::string square_elements(const Pattern& pattern) {
  const double half = pattern.half_marker();
  const int cells = static_cast<int>(std::lround(2 * half));
  std::string elements;
  const auto black = [&](int x, int y) {
    return x < cells && !pattern.white(x + 0.5 - half, y + 0.5 - half);
  };
  for (int y = 0; y < cells; ++y)
    for (int x = 0; x < cells; ++x) {
      const int begin = x;
      while (black(x, y)) ++x;
      if (x > begin)
        elements += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"1.001\"/>",
                                begin - half, y - half, x - begin);
    }
  return elements;
}

// A plate whose centre is at (x, y) [mm], with its label.
std::string plate_at(const Family& family, std::size_t number, double side, double x, double y) {
  const Pattern pattern(family, number);
  const double half = pattern.half_plate(), millimetres = 1000 * side;
  const std::string elements =
      family.kind == Kind::ring ? ring_elements(pattern, family.bits) : square_elements(pattern);
  return fmt::format(
      "<g transform=\"translate({} {}) scale({:.6f})\">{}</g>\n"
      "<text x=\"{}\" y=\"{}\" font-size=\"{}\" font-family=\"sans-serif\" "
      "text-anchor=\"middle\">{} ({}), {:g} mm</text>\n",
      x, y, millimetres / (2 * half), elements, x, y + millimetres / 2 + kText + 2, kText,
      label_of(family, number), family.name, millimetres);
}

std::string drawing(double width, double height, const std::string& elements) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:g}mm\" height=\"{1:g}mm\" "
      "viewBox=\"0 0 {0:g} {1:g}\">\n<rect width=\"{0:g}\" height=\"{1:g}\" fill=\"white\"/>\n"
      "{2}</svg>\n",
      width, height, elements);
}

}  // namespace

std::string plate_svg(const Family& family, std::size_t number, double side) {
  const double width = 1000 * side + 2 * kMargin, middle = width / 2;
  return drawing(width, width + kText, plate_at(family, number, side, middle, middle));
}

std::string bar_svg(const Family& family, std::size_t first, std::size_t second, double side,
                    double length) {
  if (first == second) fail("a bar needs two targets, but both are {}", label_of(family, first));
  if (length < side)
    fail("a bar of {:g} m is too short for plates of {:g} m: they overlap", length, side);
  const double middle = 500 * side + kMargin, far = middle + 1000 * length;
  const std::string elements = plate_at(family, first, side, middle, middle) +
                               plate_at(family, second, side, far, middle) +
                               fmt::format(
                                   "<text x=\"{}\" y=\"{}\" font-size=\"{}\" "
                                   "font-family=\"sans-serif\" text-anchor=\"middle\">centre to "
                                   "centre {:g} mm</text>\n",
                                   (middle + far) / 2, 2 * middle + kText, kText, 1000 * length);
  return drawing(far + middle, 2 * middle + 2 * kText, elements);
}

}  // namespace axial::targets
