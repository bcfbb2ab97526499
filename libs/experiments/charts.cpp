// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "picture/svg.h"

namespace axial::experiments {
namespace {

using picture::Anchor;
using picture::Rectangle;
using picture::Svg;

// Colours by Okabe and Ito, which colour-blind readers can distinguish.
constexpr std::array<const char*, 7> kColors{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                             "#8a6d00", "#56b4e9", "#000000"};
constexpr double kTitleHeight = 34;

// Maps [low, high] linearly, or logarithmically, to [begin, end] of the drawing.
struct Axis {
  double low, high, begin, end;
  bool logarithmic = false;

  double at(double value) const {
    const double part = logarithmic ? std::log(std::max(value, low) / low) / std::log(high / low)
                                    : (value - low) / (high - low);
    return begin + part * (end - begin);
  }

  std::vector<double> ticks() const {
    std::vector<double> ticks;
    if (logarithmic) {
      for (int e = -12; e <= 12; ++e)
        if (const double tick = std::pow(10, e); tick >= low * 0.999 && tick <= high * 1.001)
          ticks.push_back(tick);
      return ticks;
    }
    const double rough = (high - low) / 5;
    const double power = std::pow(10, std::floor(std::log10(rough)));
    double step = 10 * power;
    for (const double m : {5.0, 2.0, 1.0})
      if (m * power >= rough) step = m * power;
    for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k)
      ticks.push_back(k * step + 0.0);  // no -0
    return ticks;
  }
};

struct Range {
  double low, high;
};

template <class Values>
Range range_of(const LinePanel& panel, Values values) {
  Range range{HUGE_VAL, -HUGE_VAL};
  for (const Line& line : panel.lines)
    for (const double value : values(line))
      range = {std::min(range.low, value), std::max(range.high, value)};
  return range;
}

Axis x_axis(const LinePanel& panel, double begin, double end) {
  const Range range = range_of(panel, [](const Line& line) { return line.x; });
  return {range.low, range.high > range.low ? range.high : range.low + 1, begin, end};
}

// A logarithmic axis has whole decades; a linear axis starts at zero.
Axis y_axis(const LinePanel& panel, double begin, double end) {
  const Range range = range_of(panel, [](const Line& line) { return line.y; });
  if (!panel.logarithmic) return {0, range.high > 0 ? 1.05 * range.high : 1, begin, end};
  const double low = std::max(range.low, 1e-9);
  return {std::pow(10, std::floor(std::log10(low))),
          std::pow(10, std::floor(std::log10(std::max(range.high, low))) + 1), begin, end, true};
}

void draw_frame(Svg& svg, const LinePanel& panel, const Axis& x, const Axis& y) {
  svg.text(x.begin, y.end - 10, panel.title, Anchor::kStart, "title");
  svg.text(0.5 * (x.begin + x.end), y.begin + 34, panel.x_title, Anchor::kMiddle);
  svg.upright_text(x.begin - 50, 0.5 * (y.begin + y.end), panel.y_title);
  for (const double tick : x.ticks()) {
    svg.line(x.at(tick), y.begin, x.at(tick), y.end, "grid");
    svg.text(x.at(tick), y.begin + 16, fmt::format("{:g}", tick), Anchor::kMiddle, "small");
  }
  for (const double tick : y.ticks()) {
    svg.line(x.begin, y.at(tick), x.end, y.at(tick), "grid");
    svg.text(x.begin - 6, y.at(tick) + 4, fmt::format("{:.4g}", tick), Anchor::kEnd, "small");
  }
  svg.line(x.begin, y.begin, x.end, y.begin, "axis");
  svg.line(x.begin, y.begin, x.begin, y.end, "axis");
}

void draw_panel(Svg& svg, const LinePanel& panel, const Rectangle& where) {
  constexpr double kLegendLine = 16;
  const double legend = kLegendLine * static_cast<double>(panel.lines.size());
  const Axis x = x_axis(panel, where.x + 62, where.x + where.width - 14);
  const Axis y = y_axis(panel, where.y + where.height - 48 - legend, where.y + 24);
  draw_frame(svg, panel, x, y);
  for (std::size_t k = 0; k < panel.lines.size(); ++k) {
    const Line& line = panel.lines[k];
    const char* color = kColors[k % kColors.size()];
    std::vector<cv::Point2d> points;
    for (std::size_t i = 0; i < line.x.size(); ++i) {
      points.emplace_back(x.at(line.x[i]), y.at(line.y[i]));
      if (panel.marked)
        svg.circle(points.back().x, points.back().y, color,
                   fmt::format("{}: {:.4g}, {:.4g}", line.name, line.x[i], line.y[i]));
    }
    svg.polyline(points, color);
    const double place = y.begin + 52 + kLegendLine * static_cast<double>(k);
    svg.box({x.begin, place - 9, 10, 10}, color);
    svg.text(x.begin + 16, place, line.name, Anchor::kStart, "small");
  }
}

// Colours of values in [0, highest]; grey for missing values.
cv::Mat3b colored(const MapPanel& panel, double highest) {
  const int width = static_cast<int>(panel.width);
  const cv::Mat1d values(static_cast<int>(panel.values.size()) / width, width,
                         const_cast<double*>(panel.values.data()));
  cv::Mat1b scaled;
  values.convertTo(scaled, CV_8U, 255 / highest);
  cv::Mat3b bgr;
  cv::applyColorMap(scaled, bgr, cv::COLORMAP_VIRIDIS);
  bgr.setTo(cv::Scalar(190, 190, 190), values < 0);
  // Enlarges small maps: not every viewer draws enlarged pixels as squares.
  const int factor = width < 100 ? std::max(1, 200 / width) : 1;
  cv::resize(bgr, bgr, {}, factor, factor, cv::INTER_NEAREST);
  return bgr;
}

void draw_scale(Svg& svg, const Rectangle& where, double highest, const std::string& unit) {
  MapPanel bar{"", 20, {}};
  for (int k = 255; k >= 0; --k) bar.values.insert(bar.values.end(), bar.width, k * highest / 255);
  svg.picture(where, colored(bar, highest));
  const Axis axis{0, highest, where.y + where.height, where.y};
  for (const double tick : axis.ticks())
    svg.text(where.x + where.width + 5, axis.at(tick) + 4, fmt::format("{:g}", tick),
             Anchor::kStart, "small");
  svg.text(where.x, where.y - 8, unit, Anchor::kStart, "small");
}

}  // namespace

std::string draw_lines(const std::string& title, const std::vector<LinePanel>& panels,
                       std::size_t columns) {
  constexpr double kWidth = 320;
  std::size_t most = 0;
  for (const LinePanel& panel : panels) most = std::max(most, panel.lines.size());
  const double height = 260 + 16 * static_cast<double>(most);
  const std::size_t rows = (panels.size() + columns - 1) / columns;
  Svg svg(kWidth * static_cast<double>(columns), kTitleHeight + height * static_cast<double>(rows));
  svg.text(12, 22, title, Anchor::kStart, "title");
  for (std::size_t k = 0; k < panels.size(); ++k)
    draw_panel(svg, panels[k],
               {kWidth * static_cast<double>(k % columns),
                kTitleHeight + height * static_cast<double>(k / columns), kWidth, height});
  return svg.str();
}

std::string draw_maps(const std::string& title, const std::vector<MapPanel>& panels,
                      std::size_t columns, double highest, const std::string& unit) {
  constexpr double kSide = 200, kGap = 14, kHead = 26;
  const std::size_t rows = (panels.size() + columns - 1) / columns;
  const double right = kGap + (kSide + kGap) * static_cast<double>(columns);
  const double bottom = kTitleHeight + (kSide + kHead) * static_cast<double>(rows);
  Svg svg(right + 80, bottom + kGap);
  svg.text(kGap, 22, title, Anchor::kStart, "title");
  for (std::size_t k = 0; k < panels.size(); ++k) {
    const double x = kGap + (kSide + kGap) * static_cast<double>(k % columns);
    const double y = kTitleHeight + (kSide + kHead) * static_cast<double>(k / columns);
    svg.text(x, y + 18, panels[k].title, Anchor::kStart, "small");
    svg.picture({x, y + kHead, kSide, kSide}, colored(panels[k], highest));
  }
  draw_scale(svg, {right + 4, kTitleHeight + kHead, 16, bottom - kTitleHeight - kHead}, highest,
             unit);
  return svg.str();
}

}  // namespace axial::experiments
