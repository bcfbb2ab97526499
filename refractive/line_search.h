// SPDX-License-Identifier: BSD-3-Clause
// The paper's forward projection (Algorithm 1; docs/refraction.md names the paper). The algorithm
// bisects the line in which the plane of refraction meets the image. It uses only a table of the
// pixels' rays. Its error is about a quarter of a pixel. It is here for comparisons, and for
// cameras of which only a table of rays is known. The exact projection (FlatPortCamera::project) is
// faster.
//
// The symbols of the paper: x_p is the pinhole image of X, and x_n is the pixel at which the axis
// meets the image. The printed algorithm leaves some cases open and treats others wrongly. This
// implementation differs as follows:
//   - The table is one pixel larger than the image on every side, and the line is clipped half a
//     pixel outside the image's area. So rounding never leaves the table. A point is outside the
//     image if and only if the search ends outside the image's area. The printed algorithm also
//     drops points whose search ends within half a pixel of the line's end, although many of these
//     points are inside.
//   - The search tests at least one pixel, even if the line is too short to bisect. In the printed
//     algorithm, the variable `forward` has no value for such a line.
//   - For a point on the axis the line has no direction, and the result is x_p.
//   - The direction of the line is computed from X and n without x_n, because x_n does not exist
//     if the port's normal is perpendicular to the optical axis.
//   - Points on the lens's side of the outer plane, and NaN, are rejected.
//   - alpha and beta are the cosines of the angles that the paper's text compares, because the
//     printed algorithm computes cosines. The comparison is therefore the reverse of the comparison
//     of angles.
// The search rounds positions on the line to pixels. Therefore the result of the comparison is not
// monotone along the line within 0.7 px. This rounding causes most of the error.
#pragma once

#include <cmath>
#include <memory>
#include <optional>

#include "refractive/flat_port_camera.h"
#include "refractive/pixel_lookup.h"

namespace axial::refractive {

// A segment of a line in the image [px].
template <class T>
struct Segment {
  Vector2<T> start, end;
};

// The part of the ray start + t * step, t >= 0, that lies inside the rectangle from `low` to
// `high` (algorithm: Liang and Barsky). Empty if the ray does not meet the rectangle, if `step` is
// zero, or if `start` or `step` is not finite.
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

// The direction [px] of the line in which the plane of refraction of X meets the image, pointing
// away from the axis. Let J be the lens's Jacobian d(pixel)/dX at X, and e the component of X
// perpendicular to the axis. The result is J e. It is parallel to x_p - x_n and about |x_p - x_n|
// pixels long. `n`: the port's normal. X and n are in the camera frame. Precondition: X.z > 0.
template <class T>
Vector2<T> refraction_line(const PinholeLens<T>& lens, const Vector3<T>& n, const Vector3<T>& X) {
  const T inv_z = T(1) / X.z();
  return {lens.fx * (X.x() * n.z() - n.x() * X.z()) * inv_z,
          lens.fy * (X.y() * n.z() - n.y() * X.z()) * inv_z};
}

// The bisection of Algorithm 1. `line`: the clipped line [px], which starts at the end nearer to
// x_p. Returns the pixel at which the search ends. Precondition: X [camera frame, m] lies beyond
// the port.
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

// A flat port camera that projects by Algorithm 1. It has those functions of FlatPortCamera that
// the paper's method needs, so that the type of the camera selects the method of projection. Rays
// and Jacobians are those of the exact camera. `T` is float or double.
template <class T>
class LineSearchCamera {
 public:
  using Scalar = T;

  // `lens`: the lens in air. `width`, `height`: size of the image [px]. Copies of the camera share
  // one table of 4 numbers per pixel. The preconditions of FlatPort are not checked.
  LineSearchCamera(const PinholeLens<T>& lens, const FlatPort<T>& port, int width, int height)
      : exact_(lens, port, width, height),
        low_(T(-1), T(-1)),
        high_(static_cast<T>(width), static_cast<T>(height)),
        lookup_(std::make_shared<const PixelLookup<T>>(exact_, width, height, 1)) {}

  const PinholeLens<T>& lens() const { return exact_.lens(); }
  const FlatPort<T>& port() const { return exact_.port(); }
  Matrix3<T> rotation_to_axis() const { return exact_.rotation_to_axis(); }
  // The exact camera, and the table of the pixels' rays.
  const FlatPortCamera<T>& exact() const { return exact_; }
  const PixelLookup<T>& lookup() const { return *lookup_; }

  // The ray of `pixel` and its derivatives by the pixel, from FlatPortCamera::ray().
  AxialRay<T> ray(const Vector2<T>& pixel) const { return exact_.ray(pixel); }
  AxialRay<T> ray(const Vector2<T>& pixel, AxialRayJacobian<T>& jacobian) const {
    return exact_.ray(pixel, jacobian);
  }

  // The projection of X [camera frame, m]. X is visible if the search ends inside the image
  // without a margin: u in [-1/2, width - 1/2], v in [-1/2, height - 1/2]. X is not visible if it
  // lies on the lens's side of the outer plane, or behind the lens, or is NaN. The pixel of a
  // point that is not visible is (0, 0). `jacobian` receives d(pixel)/dX [px/m] of
  // FlatPortCamera::project(). It may be null.
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
