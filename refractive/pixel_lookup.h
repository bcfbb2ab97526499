// SPDX-License-Identifier: BSD-3-Clause
// The paper's lookup table L(pixel) = {C_v, X_v, c_v}: an axial camera as a table of the rays of
// its pixels. C_v is the origin and X_v the direction of the pixel's ray in water. c_v is the
// principal point of the pixel's virtual camera (virtual_camera.h). docs/refraction.md names the
// paper.
#pragma once

#include <cstddef>
#include <vector>

#include "refractive/axial_ray.h"
#include "refractive/virtual_camera.h"

namespace axial::refractive {

struct IntegerPixel {
  int u, v;
};

// A table of four numbers per pixel: the height of C_v on the axis and the direction X_v. c_v is
// computed from these numbers when it is needed.
template <class T>
class PixelLookup {
 public:
  struct Entry {
    Vector3<T> centre;           // C_v [camera frame, m]
    Vector3<T> direction;        // X_v: unit, in water [camera frame]
    Vector2<T> principal_point;  // c_v [px]
  };

  // The four numbers that the table stores for one pixel.
  struct Cell {
    T along;               // C_v = along * axis() [m]
    Vector3<T> direction;  // X_v
  };

  // Fills the table with the rays of `camera`, any type with lens(), port(), rotation_to_axis() and
  // ray() as FlatPortCamera has them. The table covers the image of width x height pixels, widened
  // by `border` (>= 0) pixels on every side.
  template <class Camera>
  PixelLookup(const Camera& camera, int width, int height, int border = 0)
      : lens_(camera.lens()),
        axis_(camera.port().normal),
        rotation_(camera.rotation_to_axis()),
        low_(-border),
        high_u_(width - 1 + border),
        high_v_(height - 1 + border) {
    cells_.reserve(static_cast<std::size_t>(high_u_ - low_ + 1) *
                   static_cast<std::size_t>(high_v_ - low_ + 1));
    for (int v = low_; v <= high_v_; ++v) {
      for (int u = low_; u <= high_u_; ++u) {
        const AxialRay<T> ray = camera.ray({static_cast<T>(u), static_cast<T>(v)});
        cells_.push_back({ray.origin.dot(axis_), ray.direction});
      }
    }
  }

  // The camera's axis: the unit normal of the port, in the camera frame.
  const Vector3<T>& axis() const { return axis_; }

  // The pixel of the table nearest to `pixel`. Halves are rounded upwards. A coordinate outside
  // the table becomes the coordinate of the table's edge. A NaN coordinate becomes the smallest
  // coordinate of the table.
  IntegerPixel round(const Vector2<T>& pixel) const {
    return {round_clamped(pixel.x(), high_u_), round_clamped(pixel.y(), high_v_)};
  }

  // The stored numbers of the pixel p. Precondition: p lies inside the table, as the results of
  // round() do.
  const Cell& cell(const IntegerPixel& p) const {
    const auto stride = static_cast<std::size_t>(high_u_ - low_ + 1);
    return cells_[static_cast<std::size_t>(p.v - low_) * stride +
                  static_cast<std::size_t>(p.u - low_)];
  }

  // The ray of the pixel p in water, in the camera frame. Precondition: p lies inside the table.
  AxialRay<T> ray(const IntegerPixel& p) const {
    const Cell& c = cell(p);
    return {c.along * axis_, c.direction};
  }

  // The entry L(pixel) for the table's pixel nearest to `pixel`.
  Entry entry(const Vector2<T>& pixel) const {
    const VirtualCamera<T> camera = virtual_camera(pixel);
    return {camera.centre, cell(round(pixel)).direction, {camera.lens.cx, camera.lens.cy}};
  }

  // The virtual camera (virtual_camera.h) for the table's pixel nearest to `pixel`.
  VirtualCamera<T> virtual_camera(const Vector2<T>& pixel) const {
    const IntegerPixel p = round(pixel);
    return refractive::virtual_camera(lens_, rotation_, ray(p),
                                      Vector2<T>(static_cast<T>(p.u), static_cast<T>(p.v)));
  }

 private:
  int round_clamped(const T& x, int high) const {
    if (!(x > static_cast<T>(low_))) return low_;
    if (x >= static_cast<T>(high)) return high;
    return static_cast<int>(x - static_cast<T>(low_) + T(0.5)) + low_;
  }

  PinholeLens<T> lens_;
  Vector3<T> axis_;
  Matrix3<T> rotation_;
  int low_, high_u_, high_v_;  // first u and v, last u and last v of the table
  std::vector<Cell> cells_;
};

}  // namespace axial::refractive
