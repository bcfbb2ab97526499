// SPDX-License-Identifier: GPL-3.0-or-later
// A lens in air: projection of a direction and its inverse, the matcher's form of the lens, and the
// pinhole that replaces it. Pixel centres are at integers.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "lens/models.h"
#include "refractive/lens_distortion.h"
#include "refractive/pinhole_camera.h"

namespace axial::lens {

struct Lens {
  const Model* model = nullptr;
  refractive::PinholeLens<double> pinhole{};  // the lens without its distortion
  std::vector<double> distortion;             // the Parameters of `model`
  int width = 0, height = 0;                  // of the image [px]
};

// Projects the in-air direction (u, v, 1) to a pixel. NaN where the model is not defined.
Eigen::Vector2d image_direction(const Lens& lens, double u, double v);

// The same for `direction` (u, v), with the derivative by (u, v).
refractive::PlanePoint<double> image_with_derivative(const Lens& lens,
                                                     const Eigen::Vector2d& direction);

// The inverse of image_direction, with the derivative of image_direction at the result.
struct ImagedDirection {
  Eigen::Vector2d direction;   // (u, v)
  Eigen::Matrix2d derivative;  // d(pixel)/d(u, v) there
};

// Returns the in-air direction that the lens projects to `pixel`. Newton's method starts from the
// direction of the undistorted lens. Nothing if no direction projects to the pixel, if the method
// does not converge, or if the lens folds back between the axis and the direction.
std::optional<ImagedDirection> direction_at(const Lens& lens, const Eigen::Vector2d& pixel);

// How far from its axis a lens images directions.
struct Field {
  // The largest |(u, v)| at which the lens has not folded back on at least one of 16 sides of the
  // axis: directions that move away from the axis also move outwards in the image. It does not
  // depend on the focal lengths. Where another side folds back earlier, callers test the
  // determinant of the derivative. This test is sufficient if the sides fold back at similar
  // angles.
  double reach = 0;
  // The largest |(u, v)| of the image corners, at most `reach` and at most the tangent of 85
  // degrees. A corner that no direction projects to counts as a corner at the smaller of these two
  // limits.
  double corner = 0;
};
// Zeros for a lens without a model.
Field field_of(const Lens& lens);

// The same as direction_at() above, with the field of the lens. It is faster, because it does not
// search for a fold between the axis and the direction.
std::optional<ImagedDirection> direction_at(const Lens& lens, const Field& field,
                                            const Eigen::Vector2d& pixel);

// Returns the lens if it is a pinhole: PINHOLE, SIMPLE_PINHOLE, or a perspective lens model whose
// distortion parameters are all exactly zero.
std::optional<refractive::PinholeLens<double>> pinhole_lens(const Lens& lens);

// Returns the distortion of the lens relative to its `pinhole`, in the form that the matcher uses.
// The perspective and fisheye polynomials and FOV are exact. The division models and EUCM are
// fitted, with an error of at most 1e-4 px up to the image corners. Nothing for pinholes, for
// RAD_TAN_THIN_PRISM_FISHEYE, and for lenses that cannot be fitted so well.
std::optional<refractive::LensDistortion<double>> lens_distortion(const Lens& lens);

// Returns a pinhole that replaces the lens without a black border in the undistorted image. It has
// the lens's image size, principal point and ratio of focal lengths. Its focal length is the
// shortest, between half and four times that of the lens, for which every pixel lies inside the
// image of the lens. Nothing if there is none.
std::optional<refractive::PinholeLens<double>> pinhole_inside(const Lens& lens);

// Returns, for every pixel of the pinhole, its position in the image of the lens: the map for
// cv::remap.
cv::Mat2f undistortion_map(const Lens& lens, const refractive::PinholeLens<double>& pinhole);

}  // namespace axial::lens
