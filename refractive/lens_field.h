// SPDX-License-Identifier: GPL-3.0-or-later
// How far out a lens is defined: polynomials fold back beyond the field they were fitted to, and a
// direction from there would land inside the image again.
#pragma once

#include <cmath>
#include <numbers>

#include "refractive/lens_distortion.h"
#include "refractive/pinhole_camera.h"
#include "refractive/widened_image.h"

namespace axial::refractive {

// Directions this far from the optical axis are no lens's in front of a port, nor on a plane.
inline constexpr double kWidestAngle = 85 * std::numbers::pi / 180;

namespace detail {

// |e| of the directions at `angle` from the optical axis.
inline double field_at(const LensDistortion<double>& distortion, double angle) {
  const double r = distortion.spread * std::tan(angle);
  return distortion.fisheye > 0 ? std::atan(r) : r;
}

// What of a circle |e| = radius the lens shows.
struct FieldCircle {
  bool grows = true;     // everywhere outwards, and without turning the picture over
  double reaches = 1e9;  // the smallest distance of its image from the centre's [focal lengths]
};

// `by_angle`: d|e|/d(angle) there.
inline FieldCircle field_circle(const LensDistortion<double>& distortion, double radius,
                                double by_angle) {
  // Where hardly any pixel is left for an angle, single precision has no inverse.
  constexpr double kLeastGrowth = 0.02;
  constexpr int kDirections = 16;
  FieldCircle circle;
  for (int k = 0; k < kDirections; ++k) {
    const double turn = 2 * std::numbers::pi * k / kDirections;
    const Vector2<double> out(std::cos(turn), std::sin(turn));
    const PlanePoint<double> d = distortion.bent(radius * out);
    const double growth = out.dot(d.by * out) * by_angle;
    // False for NaN.
    if (!(growth > kLeastGrowth && determinant_of(d.by) > 0)) circle.grows = false;
    circle.reaches = std::fmin(circle.reaches, d.point.norm());
  }
  return circle;
}

}  // namespace detail

// The largest |e| (lens_distortion.h) up to which every direction moves outwards in the image, but
// not much beyond `image` [px], nor beyond kWidestAngle. 0: the lens is turned over, or no lens.
inline double lens_field(const PinholeLens<double>& lens, const LensDistortion<double>& distortion,
                         const WidenedImage<double>& image) {
  double corner = 0;  // the farthest, in focal lengths
  for (const double u : {image.lowest, image.highest_u})
    for (const double v : {image.lowest, image.highest_v})
      corner = std::fmax(corner, std::hypot((u - lens.cx) / lens.fx, (v - lens.cy) / lens.fy));
  constexpr int kSteps = 1000;
  double field = 0;
  for (int i = 1; i <= kSteps; ++i) {
    const double angle = kWidestAngle * i / kSteps;
    const double radius = detail::field_at(distortion, angle);
    const detail::FieldCircle circle =
        detail::field_circle(distortion, radius, (radius - field) / (kWidestAngle / kSteps));
    if (!circle.grows) break;
    field = radius;
    if (circle.reaches > corner) break;
  }
  return field;
}

}  // namespace axial::refractive
