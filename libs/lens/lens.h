// SPDX-License-Identifier: GPL-3.0-or-later
// A lens in air: the projection of a direction, the inverse of the projection, the matcher's form
// of the lens, and the pinhole that replaces the lens. Pixel centres are at integers.
//
// The in-air direction (u, v, 1) is in the camera frame: x to the right, y down, z along the
// optical axis. Its scale has no meaning: (u, v) are the tangents x / z and y / z. The matcher's
// form of a lens is refractive::LensDistortion.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "lens/models.h"
#include "refractive/lens_distortion.h"
#include "refractive/pinhole_camera.h"

namespace axial::lens {

// A lens of one of COLMAP's models.
struct Lens {
  const Model* model = nullptr;               // null: no lens; see find_model() in models.h
  refractive::PinholeLens<double> pinhole{};  // focal lengths and principal point [px]
  std::vector<double> distortion;             // the distortion parameters of `model`, in its order
  int width = 0, height = 0;                  // of the image [px]
};

// Projects the in-air direction (u, v, 1) to a pixel. The result is NaN where the model is not
// defined. It may lie outside the image. Precondition for this and all functions below, except
// field_of(): the lens has a model.
Eigen::Vector2d image_direction(const Lens& lens, double u, double v);

// Projects the in-air direction (u, v, 1), where (u, v) = `direction`, to a pixel, as
// image_direction() does. In the result, `point` is the pixel and `by` is d(pixel)/d(u, v) [px],
// rows x and y of the pixel. Both are NaN where the model is not defined.
refractive::PlanePoint<double> image_with_derivative(const Lens& lens,
                                                     const Eigen::Vector2d& direction);

// The direction of a pixel: the result of direction_at().
struct ImagedDirection {
  Eigen::Vector2d direction;   // (u, v) of the in-air direction (u, v, 1)
  Eigen::Matrix2d derivative;  // d(pixel)/d(u, v) at `direction` [px]
};

// The inverse of image_direction(): returns the in-air direction that the lens projects to `pixel`,
// which may lie outside the image. Newton's method starts from the direction of the undistorted
// lens. Empty if no direction projects to the pixel, if the method does not converge, or if the
// lens folds back between the axis and the direction. A lens folds back where directions farther
// from the axis do not move outwards in the image.
std::optional<ImagedDirection> direction_at(const Lens& lens, const Eigen::Vector2d& pixel);

// How far from its axis a lens images directions. The length |(u, v)| of a direction is the tangent
// of its angle from the axis.
struct Field {
  // The largest |(u, v)| up to which the lens does not fold back (see direction_at() above) at one
  // or more of 16 azimuths around the axis. `reach` does not depend on the focal lengths. At
  // another azimuth, the lens may fold back at a smaller |(u, v)|. Callers therefore also test the
  // determinant of the derivative. This test is sufficient if the lens folds back at similar angles
  // at all azimuths.
  double reach = 0;
  // The largest |(u, v)| of the directions of the four image corners. It is at most a limit, the
  // smaller of `reach` and the tangent of 85 degrees. If no direction projects to a corner,
  // `corner` is this limit.
  double corner = 0;
};

// Returns how far `lens` images directions. The result is zero for a lens without a model.
Field field_of(const Lens& lens);

// Returns the in-air direction that the lens projects to `pixel`, as direction_at() above does, but
// faster: the function does not test whether the lens folds back between the axis and the
// direction. Instead, the result is empty if |(u, v)| of the direction is larger than field.reach.
// Precondition: `field` is field_of(lens).
std::optional<ImagedDirection> direction_at(const Lens& lens, const Field& field,
                                            const Eigen::Vector2d& pixel);

// Returns `lens.pinhole` if the lens has no distortion: if its model is PINHOLE or SIMPLE_PINHOLE,
// or if Model::flat is true and all distortion parameters are exactly zero. Otherwise empty.
std::optional<refractive::PinholeLens<double>> pinhole_lens(const Lens& lens);

// Returns the distortion of the lens in the matcher's form. Focal lengths and principal point of
// the lens in this form are those of `lens.pinhole`. The perspective and fisheye polynomials and
// FOV are converted exactly. The division models and EUCM are fitted, with an error of at most 1e-4
// px up to the image corners, at most up to 85 degrees from the axis. Empty for lenses that
// pinhole_lens() accepts, for RAD_TAN_THIN_PRISM_FISHEYE, and for lenses whose fit has a larger
// error.
std::optional<refractive::LensDistortion<double>> lens_distortion(const Lens& lens);

// Returns a pinhole that replaces the lens without a black border in the undistorted image. The
// pinhole has the lens's image size, principal point and ratio of focal lengths. Its focal length
// is between half and four times the focal length of the lens. The result has the shortest focal
// length in this range for which every sampled border pixel of the pinhole lies inside the image of
// the lens. Empty if no focal length in the range meets this condition.
std::optional<refractive::PinholeLens<double>> pinhole_inside(const Lens& lens);

// Returns the map for cv::remap that undistorts images of the lens: for every pixel (row y, column
// x) of an image of `pinhole`, the position (x, y) [px] in the image of the lens. The map has the
// size of the lens's image. A position may lie outside this image. It is NaN where the model is not
// defined.
cv::Mat2f undistortion_map(const Lens& lens, const refractive::PinholeLens<double>& pinhole);

}  // namespace axial::lens
