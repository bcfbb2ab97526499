// SPDX-License-Identifier: BSD-3-Clause
// The field of a lens: how far from the optical axis its distortion model is valid. The polynomial
// of a lens may stop growing beyond the field to which it was fitted. The polynomial then maps
// directions beyond the field to pixels at which the lens images other directions.
#pragma once

#include <cmath>
#include <numbers>

#include "refractive/lens_distortion.h"
#include "refractive/pinhole_camera.h"
#include "refractive/widened_image.h"

namespace axial::refractive {

// The widest field of a lens [rad], as the angle from the optical axis. The angle is limited
// because the tangents (x/z, y/z) of a direction grow to infinity at 90 degrees.
inline constexpr double kWidestAngle = 85 * std::numbers::pi / 180;

namespace detail {

// The length |e| (lens_distortion.h) for directions at `angle` [rad] from the optical axis.
inline double field_at(const LensDistortion<double>& distortion, double angle) {
  const double r = distortion.spread * std::tan(angle);
  return distortion.fisheye > 0 ? std::atan(r) : r;
}

// Properties of the curve to which the distortion maps the circle |e| = radius.
struct FieldCircle {
  // True if each sampled point of the curve moves outwards when the angle from the optical axis
  // grows, and if the distortion does not mirror the image.
  bool grows = true;
  double reaches = 1e9;  // smallest distance of the curve from the optical axis [focal lengths]
};

// Samples the circle |e| = radius at 16 points. `by_angle`: d|e|/d(angle) at this radius.
inline FieldCircle field_circle(const LensDistortion<double>& distortion, double radius,
                                double by_angle) {
  // Least growth of the distance from the optical axis [focal lengths per radian]. If the growth
  // is smaller, the inverse of the distortion is not accurate in single precision.
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

// Returns the field of the lens: the largest |e| (lens_distortion.h) up to which the image of a
// direction moves outwards when the direction moves away from the optical axis. The search runs in
// steps from the axis outwards. It ends at the first step at which all sampled directions lie
// beyond the corners of `image` [px], and at kWidestAngle at the latest. So the result may be
// smaller than the largest such |e|, but then it covers `image`. The result is 0 if directions next
// to the axis already do not move outwards, for example because the lens mirrors the image.
inline double lens_field(const PinholeLens<double>& lens, const LensDistortion<double>& distortion,
                         const WidenedImage<double>& image) {
  double corner = 0;  // distance of the farthest corner from the principal point [focal lengths]
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
