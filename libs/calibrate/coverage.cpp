// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibrate/coverage.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "picture/svg.h"

namespace axial::calibrate {
namespace {

constexpr double kWidth = 720, kFrame = 30, kTitle = 50;
constexpr int kColumns = 8, kRows = 6;

// The colour for errors up to one, up to two, and above two times the usual error.
const char* color_of(double error, double usual) {
  if (error <= usual) return "#2b6cb0";
  return error <= 2 * usual ? "#dd8a20" : "#c0262d";
}

// The image area at the scale of the drawing.
class Drawing {
 public:
  explicit Drawing(const io::ColmapCamera& lens)
      : scale_(kWidth / static_cast<double>(lens.width)),
        height_(static_cast<double>(lens.height) * scale_),
        svg_(kWidth + 2 * kFrame, height_ + kTitle + kFrame) {}

  void head(const std::string& title) {
    svg_.text(kFrame, 22, title, picture::Anchor::kStart, "title");
    svg_.text(kFrame, 40, "error: blue: up to the RMS; orange: up to twice the RMS; red: larger",
              picture::Anchor::kStart, "small");
  }

  void grid() {
    for (int i = 0; i <= kColumns; ++i)
      svg_.line(column(i), kTitle, column(i), kTitle + height_, kind(i, kColumns));
    for (int i = 0; i <= kRows; ++i)
      svg_.line(kFrame, row(i), kFrame + kWidth, row(i), kind(i, kRows));
  }

  void corner(const Eigen::Vector2d& pixel, const char* color, const std::string& tip) {
    const double x = (pixel.x() + 0.5) * scale_, y = (pixel.y() + 0.5) * scale_;
    svg_.circle(kFrame + x, kTitle + y, color, tip);
    ++counts_[field(y, height_, kRows)][field(x, kWidth, kColumns)];
  }

  std::string finished() {
    for (std::size_t i = 0; i < counts_.size(); ++i)
      for (std::size_t j = 0; j < counts_[i].size(); ++j)
        svg_.text(column(static_cast<int>(j)) + 4, row(static_cast<int>(i)) + 14,
                  fmt::format("{}", counts_[i][j]), picture::Anchor::kStart, "small");
    return svg_.str();
  }

 private:
  static double column(int i) { return kFrame + kWidth * i / kColumns; }
  double row(int i) const { return kTitle + height_ * i / kRows; }
  static const char* kind(int i, int last) { return i % last == 0 ? "axis" : "grid"; }
  static std::size_t field(double at, double size, int fields) {
    return static_cast<std::size_t>(
        std::clamp(static_cast<int>(at / size * fields), 0, fields - 1));
  }

  double scale_, height_;
  picture::Svg svg_;
  std::array<std::array<int, kColumns>, kRows> counts_{};
};

}  // namespace

std::string coverage_svg(const Calibration& calibration) {
  const pose::Bundle& bundle = calibration.bundle.bundle;
  const std::vector<double> errors = reprojection_errors(bundle);
  const double usual = pose::root_mean_square(errors);
  Drawing drawing(calibration.bundle.lenses[0]);
  const std::size_t pieces = calibration.pieces();
  drawing.head(fmt::format("{} corners in {} photographs{}, RMS {:.2f} px", errors.size(),
                           calibration.views.size(),
                           pieces > 0 ? fmt::format(" ({} of a piece)", pieces) : "", usual));
  drawing.grid();
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const pose::Observation& seen = bundle.observations[i];
    const View& view = calibration.views[seen.image];
    drawing.corner(view.corners[seen.source].pixel, color_of(errors[i], usual),
                   fmt::format("{}: {:.2f} px", view.image, errors[i]));
  }
  return drawing.finished();
}

}  // namespace axial::calibrate
