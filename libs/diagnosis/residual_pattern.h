// SPDX-License-Identifier: GPL-3.0-or-later
// Reprojection errors over the image: their means in the cells of a grid, and whether these means
// are larger than the noise of the observations explains. A wrong port or lens shows as such a
// pattern, because it moves the points in one part of all photographs in the same way.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

namespace axial::diagnosis {

// The errors of the observations in one cell. Outliers are clipped: in each component, to four
// robust standard deviations from the cell's median.
struct PatternCell {
  std::size_t count = 0;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();            // [px]
  Eigen::Vector2d standard_error = Eigen::Vector2d::Zero();  // of `mean` [px]
  double rms = 0;                                            // of the clipped errors [px]
};

struct ResidualPattern {
  int columns = 0, rows = 0;
  std::vector<PatternCell> cells;  // row by row
  std::size_t count = 0;           // of observations in the cells
  double noise = 0;  // standard deviation of an error per axis within the cells, robust [px]
  // The RMS length [px] of the cell means without the part that noise explains. Cells count by
  // their observations.
  double systematic = 0;
  // The sum of the squared cell means in units of their standard errors, and its expected value
  // without a pattern. Only cells with kLeastInCell observations count.
  double chi_square = 0, degrees = 0;
  double deviations = 0;  // of `chi_square` from `degrees`, as a normal deviate

  // Whether there are enough cells for a judgement.
  bool tells() const { return degrees >= 16; }
  // Whether the errors show a pattern: it is significant, and not negligible beside the noise.
  bool found() const { return tells() && deviations > 5 && systematic > 0.1 * noise; }
};

inline constexpr std::size_t kLeastInCell = 12;

// The pattern of `errors` [px] at `pixels` in an image of width x height pixels. Errors that are
// not finite are left out, and so are pixels outside the image. The grid has at most `most_columns`
// columns, and fewer if a cell would have fewer than about 30 observations.
ResidualPattern residual_pattern(std::span<const Eigen::Vector2d> pixels,
                                 std::span<const Eigen::Vector2d> errors, int width, int height,
                                 int most_columns = 12);

}  // namespace axial::diagnosis
