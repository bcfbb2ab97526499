// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's forward projection: bisection on the line that the plane of refraction cuts from the
// image, by the tabled rays alone (Algorithm 1). About a quarter of a pixel, for comparison and for
// cameras known only as a table; the exact projection is faster.
//
// Where the printed algorithm is silent or wrong (FIELD section 4, item 4), this one
//   - tables one pixel more than the image on every side and clips the line half a pixel outside
//     the image's area, so that rounding never leaves the table, and a point is outside the image
//     iff the search ends outside that area. (Printed: points whose search ends within half a pixel
//     of the line's end are dropped, though many of them are inside.)
//   - tests at least once, also on a line too short to bisect, where `forward` had no value,
//   - returns x_p for a point on the axis, where the line has no direction,
//   - takes the line's direction from X and n without x_n, which a port whose normal is at right
//     angles to the optical axis has not,
//   - rejects points on the lens's side of the outer plane, and NaN,
//   - reads alpha and beta as cosines: the angle grows where the cosine falls.
// Bisecting rounded positions is not monotone within 0.7 px, which is where most of the error is.
#pragma once

#include <cmath>
#include <memory>
#include <optional>

#include "refractive/flat_port_camera.h"
#include "refractive/pixel_lookup.h"

namespace axial::refractive {

template <class T>
struct Segment {
  Vector2<T> start, end;
};

// The part of the ray start + t * step, t >= 0, inside the rectangle [low, high] (Liang and
// Barsky). None: they do not meet, the step is zero, or something is not finite.
template <class T>
std::optional<Segment<T>> clip_ray(const Vector2<T>& start, const Vector2<T>& step,
                                   const Vector2<T>& low, const Vector2<T>& high) {
  if (!start.allFinite() || !step.allFinite()) return std::nullopt;
  T enter(0);
  std::optional<T> leave;
  for (int k = 0; k < 2; ++k) {
    if (step(k) == T(0)) {
      if (!(start(k) >= low(k) && start(k) <= high(k))) return std::nullopt;
      continue;
    }
    const T first = ((step(k) > T(0) ? low(k) : high(k)) - start(k)) / step(k);
    const T last = ((step(k) > T(0) ? high(k) : low(k)) - start(k)) / step(k);
    if (first > enter) enter = first;
    if (!leave || last < *leave) leave = last;
  }
  if (!leave || !(enter <= *leave)) return std::nullopt;
  return Segment<T>{start + enter * step, start + *leave * step};
}

// Where the plane of refraction of X meets the image, from the pinhole image x_p of X away from the
// axis: direction J e with J the lens's Jacobian at X and e the part of X across the axis, which is
// that of x_p - x_n. Precondition X.z > 0. The length is about |x_p - x_n| pixels.
template <class T>
Vector2<T> refraction_line(const PinholeLens<T>& lens, const Vector3<T>& n, const Vector3<T>& X) {
  const T inv_z = T(1) / X.z();
  return {lens.fx * (X.x() * n.z() - n.x() * X.z()) * inv_z,
          lens.fy * (X.y() * n.z() - n.y() * X.z()) * inv_z};
}

// Algorithm 1's bisection on a clipped line. X [camera frame] beyond the port.
template <class T>
Vector2<T> bisect_line(const PixelLookup<T>& lookup, Segment<T> line, const Vector3<T>& X) {
  using std::sqrt;
  const T kShortest2(0.125);  // (sqrt(2)/4)^2
  const T height = X.dot(lookup.axis());
  const T rho2 = (X - height * lookup.axis()).squaredNorm();
  Vector2<T> t = T(0.5) * (line.end - line.start);
  Vector2<T> x = line.start + t;
  do {
    const auto& cell = lookup.cell(lookup.round(x));
    const T above = height - cell.along;
    const T alpha = above / sqrt(rho2 + above * above);
    const T beta = cell.direction.dot(lookup.axis());
    if (alpha < beta) line.start = x;
    t *= T(0.5);
    x = line.start + t;
  } while (t.squaredNorm() >= kShortest2);
  return x;
}

// A flat port camera that projects by Algorithm 1: for the paper's method, chosen by type alone.
// Rays and Jacobians are those of the exact camera. `T` is float or double.
template <class T>
class LineSearchCamera {
 public:
  using Scalar = T;

  // Copies share one table, of 4 numbers a pixel.
  LineSearchCamera(const PinholeLens<T>& lens, const FlatPort<T>& port, int width, int height)
      : exact_(lens, port, width, height),
        low_(T(-1), T(-1)),
        high_(static_cast<T>(width), static_cast<T>(height)),
        lookup_(std::make_shared<const PixelLookup<T>>(exact_, width, height, 1)) {}

  const PinholeLens<T>& lens() const { return exact_.lens(); }
  const FlatPort<T>& port() const { return exact_.port(); }
  Matrix3<T> rotation_to_axis() const { return exact_.rotation_to_axis(); }
  const FlatPortCamera<T>& exact() const { return exact_; }
  const PixelLookup<T>& lookup() const { return *lookup_; }

  AxialRay<T> ray(const Vector2<T>& pixel) const { return exact_.ray(pixel); }
  AxialRay<T> ray(const Vector2<T>& pixel, AxialRayJacobian<T>& jacobian) const {
    return exact_.ray(pixel, jacobian);
  }

  // Visible: the search ends inside the image, not widened: u in [-1/2, width - 1/2].
  Projection<T> project(const Vector3<T>& X, Matrix23<T>* jacobian = nullptr) const {
    if (jacobian) exact_.project(X, jacobian);
    const Projection<T> none{Vector2<T>(T(0), T(0)), false};
    const bool beyond_port = X.dot(port().normal) > exact_.optics().outer();
    if (!beyond_port || !(X.z() > T(0))) return none;
    const Vector2<T> x_p = lens().pixel(X);
    const Vector2<T> step = refraction_line(lens(), port().normal, X);
    const T kOnAxis2 = static_cast<T>(1e-6);  // a thousandth of a pixel
    if (step.squaredNorm() <= kOnAxis2) return inside(x_p);
    const std::optional<Segment<T>> line = clip_ray(x_p, step, low_, high_);
    if (!line) return none;
    return inside(bisect_line(*lookup_, *line, X));
  }

 private:
  Projection<T> inside(const Vector2<T>& x) const {
    const T half(0.5);
    const bool visible =
        x.x() >= -half && x.x() <= high_.x() - half && x.y() >= -half && x.y() <= high_.y() - half;
    return {visible ? x : Vector2<T>(T(0), T(0)), visible};
  }

  FlatPortCamera<T> exact_;
  Vector2<T> low_, high_;  // the corners of the clip window: the table's outermost pixels
  std::shared_ptr<const PixelLookup<T>> lookup_;
};

}  // namespace axial::refractive
