// SPDX-License-Identifier: GPL-3.0-or-later
// The field of a lens: how far from the optical axis its distortion model is valid. Beyond the
// field to which they were fitted, polynomials may turn back, and directions from there would be
// projected into the image a second time.
#pragma once

#include <cmath>
#include <numbers>

#include "refractive/lens_distortion.h"
#include "refractive/pinhole_camera.h"
#include "refractive/widened_image.h"

namespace axial::refractive {

// The widest field of a lens [rad]. No lens behind a port images directions that are farther from
// the optical axis, and at 90 degrees a direction has no finite tangents.
inline constexpr double kWidestAngle = 85 * std::numbers::pi / 180;

namespace detail {

// |e| (lens_distortion.h) of the directions at `angle` [rad] from the optical axis.
inline double field_at(const LensDistortion<double>& distortion, double angle) {
  const double r = distortion.spread * std::tan(angle);
  return distortion.fisheye > 0 ? std::atan(r) : r;
}

// Properties of the image of a circle |e| = radius.
struct FieldCircle {
  // A growing angle moves every point of the image outwards, and the image is not mirrored.
  bool grows = true;
  double reaches = 1e9;  // smallest distance of the image from the centre [focal lengths]
};

// Samples the circle |e| = radius. `by_angle`: d|e|/d(angle) at this radius.
inline FieldCircle field_circle(const LensDistortion<double>& distortion, double radius,
                                double by_angle) {
  // Least growth of the distance from the image's centre [focal lengths per radian]. Below it, the
  // inverse of the distortion is not accurate in single precision.
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

// The largest |e| (lens_distortion.h) up to which a direction that moves away from the optical axis
// also moves outwards in the image. The search ends once all directions of one |e| lie beyond the
// corners of `image` [px], and at kWidestAngle. The result is 0 if the condition fails already next
// to the axis, for example because the lens mirrors the image.
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
