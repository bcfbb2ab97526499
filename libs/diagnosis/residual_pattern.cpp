// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosis/residual_pattern.h"

#include <algorithm>
#include <cmath>

#include "base/order_statistics.h"
#include "diagnosis/residuals.h"

namespace axial::diagnosis {
namespace {

constexpr double kClip = 4;      // in robust standard deviations
constexpr double kPerCell = 30;  // wanted observations of a cell
constexpr int kLeastColumns = 4;

using Errors = std::vector<Eigen::Vector2d>;

int columns_for(std::size_t count, int width, int height, int most) {
  const double shape = static_cast<double>(height) / width;
  const double columns = std::sqrt(static_cast<double>(count) / kPerCell / shape);
  return std::clamp(static_cast<int>(columns), std::min(kLeastColumns, most), most);
}

// Clips the values of one axis. Returns their robust standard deviation.
double clip(Errors& errors, int axis) {
  std::vector<double> values;
  for (const Eigen::Vector2d& error : errors) values.push_back(error[axis]);
  const double median = upper_median(values);
  for (double& value : values) value -= median;
  const double deviation = deviation_about_zero(std::move(values));
  for (Eigen::Vector2d& error : errors)
    error[axis] = std::clamp(error[axis], median - kClip * deviation, median + kClip * deviation);
  return deviation;
}

// `deviation`: receives the robust standard deviation per axis.
PatternCell cell_of(Errors errors, double& deviation) {
  PatternCell cell;
  cell.count = errors.size();
  if (errors.empty()) return cell;
  const double x = clip(errors, 0), y = clip(errors, 1);
  deviation = std::sqrt((x * x + y * y) / 2);
  const auto n = static_cast<double>(errors.size());
  double square = 0;
  for (const Eigen::Vector2d& error : errors) cell.mean += error / n, square += error.squaredNorm();
  cell.rms = std::sqrt(square / n);
  Eigen::Vector2d variance = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& error : errors) variance += (error - cell.mean).cwiseAbs2();
  if (errors.size() > 1) cell.standard_error = (variance / (n - 1) / n).cwiseSqrt();
  return cell;
}

// Wilson and Hilferty's approximation.
double normal_deviate(double chi_square, double degrees) {
  const double part = 2 / (9 * degrees);
  return (std::cbrt(chi_square / degrees) - (1 - part)) / std::sqrt(part);
}

void judge(ResidualPattern& pattern) {
  double excess = 0, weight = 0;
  for (const PatternCell& cell : pattern.cells) {
    if (cell.count < kLeastInCell || !(cell.standard_error.minCoeff() > 0)) continue;
    const auto n = static_cast<double>(cell.count);
    // The squares of Student's t have the mean (n - 1) / (n - 3).
    pattern.chi_square +=
        (n - 3) / (n - 1) * cell.mean.cwiseQuotient(cell.standard_error).squaredNorm();
    pattern.degrees += 2;
    excess += n * (cell.mean.squaredNorm() - cell.standard_error.squaredNorm());
    weight += n;
  }
  if (pattern.degrees == 0) return;
  pattern.systematic = std::sqrt(std::max(0.0, excess / weight));
  pattern.deviations = normal_deviate(pattern.chi_square, pattern.degrees);
}

}  // namespace

ResidualPattern residual_pattern(std::span<const Eigen::Vector2d> pixels,
                                 std::span<const Eigen::Vector2d> errors, int width, int height,
                                 int most_columns) {
  const auto counts = [&](std::size_t i) {
    const Eigen::Vector2d place = pixels[i].array() + 0.5;
    return errors[i].allFinite() && place.x() >= 0 && place.y() >= 0 && place.x() < width &&
           place.y() < height;
  };
  ResidualPattern pattern;
  for (std::size_t i = 0; i < pixels.size(); ++i) pattern.count += counts(i);
  pattern.columns = columns_for(pattern.count, width, height, most_columns);
  const double side = static_cast<double>(width) / pattern.columns;
  pattern.rows = std::max(1, static_cast<int>(std::lround(height / side)));
  const auto cells = static_cast<std::size_t>(pattern.columns * pattern.rows);
  std::vector<Errors> in_cell(cells);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (!counts(i)) continue;
    const int column = static_cast<int>((pixels[i].x() + 0.5) / width * pattern.columns);
    const int row = static_cast<int>((pixels[i].y() + 0.5) / height * pattern.rows);
    in_cell[static_cast<std::size_t>(row * pattern.columns + column)].push_back(errors[i]);
  }
  double squares = 0;
  for (Errors& here : in_cell) {
    double deviation = 0;
    pattern.cells.push_back(cell_of(std::move(here), deviation));
    squares += static_cast<double>(pattern.cells.back().count) * deviation * deviation;
  }
  if (pattern.count > 0) pattern.noise = std::sqrt(squares / static_cast<double>(pattern.count));
  judge(pattern);
  return pattern;
}

}  // namespace axial::diagnosis
