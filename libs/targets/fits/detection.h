// SPDX-License-Identifier: GPL-3.0-or-later
// A coded target in a photograph.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

namespace axial::targets {

// A place in a photograph [px]. The corner of the first pixel is (0, 0), its centre is (0.5, 0.5)
// (COLMAP's convention). `sigma`: the standard deviation of each coordinate [px].
struct ImagePoint {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double sigma = 0;
};

// The result of a fit. Where the pixels fit exactly, other errors of the model remain: `sigma` is
// at least 0.002 px.
inline ImagePoint image_point(const Eigen::Vector2d& pixel_with_integer_centres,
                              const Eigen::Matrix2d& covariance) {
  constexpr double kLeast = 0.002;
  return {pixel_with_integer_centres.array() + 0.5,
          std::sqrt(covariance.trace() / 2 + kLeast * kLeast)};
}

struct Detection {
  std::string label;       // label_of() (family.h)
  std::size_t number = 0;  // numbers_of() (family.h)
  std::size_t code = 0;    // code_of() (family.h)
  // Ring: the centre of the dot's ellipse, which is not the image of the dot's centre. Square: the
  // intersection of the diagonals. Board: the corner.
  ImagePoint centre;
  // Square: the corners of the black border: top left, top right, bottom right, bottom left of the
  // marker that is not turned. Others: nothing.
  std::optional<std::array<ImagePoint, 4>> corners{};
  // Ring: the symmetric matrix [1/px] that maps the ellipse of the dot to the unit circle. Others:
  // zero.
  Eigen::Matrix2d dot = Eigen::Matrix2d::Zero();
  // Square root of the area of the plate in the photograph [px]. Board: side of a square [px].
  double width = 0;
  // Correlation (at most 1) of the photograph with the pattern of the target.
  double agreement = 0;
};

}  // namespace axial::targets
