// SPDX-License-Identifier: BSD-3-Clause
// A lens with distortion: converts between pixels and tangents. The tangents (u, v) stand for the
// direction in air (u, v, 1) in the camera frame. e is the plane point of lens_distortion.h.
#pragma once

#include "refractive/lens_field.h"

namespace axial::refractive {

template <class T>
struct DistortedLens {
  PinholeLens<T> pinhole;  // focal lengths and principal point [px]
  LensDistortion<T> distortion;
  T field = T(0);         // largest |e| at which the lens sees a direction (lens_field())
  WidenedImage<T> image;  // a direction is visible if its pixel lies in this rectangle

  DistortedLens() = default;  // invalid until each_field() has filled it

  // `lens`: focal lengths and principal point [px]. `bends`: the distortion. `width`, `height`:
  // size of the image [px]. `margin` [px]: the image is widened by this margin on every side. A
  // negative margin stands for an eighth of the longer side, rounded down. The constructor computes
  // `field` with lens_field().
  DistortedLens(const PinholeLens<double>& lens, const LensDistortion<double>& bends, int width,
                int height, int margin = -1)
      : pinhole(lens.cast<T>()), distortion(bends.template cast<T>()) {
    const double widened = WidenedImage<double>::margin_or_default(width, height, margin);
    field = static_cast<T>(lens_field(lens, bends, {width, height, widened}));
    image = {width, height, static_cast<T>(widened)};
  }

  // True if the lens images a direction of its field at `pixel` (to 0.01 px). False if the pixel
  // lies beyond the image of the field, or is NaN. The image rectangle is not tested.
  bool shows(const Vector2<T>& pixel) const {
    const Vector2<T> found = project(tangents(pixel).point).projection.pixel;
    return (found - pixel).squaredNorm() < T(1e-4);
  }

  // True if shows() holds for the four corners of the image of width x height pixels. The corners
  // are sufficient, because the pixel farthest from the principal point is always a corner.
  bool shows_all(int width, int height) const {
    bool all = true;
    for (const T& u : {T(0), T(width - 1)})
      for (const T& v : {T(0), T(height - 1)}) all = all && shows({u, v});
    return all;
  }

  // Calls visit(number) for every number of the lens, in a fixed order. The SIMD code uses it as it
  // uses FlatPortCamera::each_field().
  template <class Visit>
  void each_field(Visit&& visit) {
    visit(pinhole.fx), visit(pinhole.fy), visit(pinhole.cx), visit(pinhole.cy);
    distortion.each_field(visit);
    visit(field);
    image.each_field(visit);
  }

  // The image of a direction in air, given by its tangents. `projection`: not visible if the
  // direction lies beyond the lens's field or if the pixel lies outside the widened image. `by`:
  // d(pixel)/d(tangents) [px]. Finite tangents give finite results. The pixel of a direction that
  // is not visible is meaningless.
  struct Image {
    Projection<T> projection;
    Matrix2<T> by;
  };
  Image project(const Vector2<T>& tangents) const {
    const PlanePoint<T> e = distortion.spread_out(tangents);
    const Mask<T> defined = e.point.x() * e.point.x() + e.point.y() * e.point.y() <= field * field;
    // Points outside the field are moved to its edge, because far outside the field the polynomials
    // exceed the range of single precision.
    const PlanePoint<T> d = distortion.bent(detail::within(e.point, field));
    Image at;
    at.projection.pixel = {pinhole.fx * d.point.x() + pinhole.cx,
                           pinhole.fy * d.point.y() + pinhole.cy};
    at.projection.visible = defined && image.contains(at.projection.pixel);
    at.by = d.by * e.by;
    at.by.row(0) *= pinhole.fx;
    at.by.row(1) *= pinhole.fy;
    return at;
  }

  // The tangents of the direction whose image is `pixel`, and d(tangents)/d(pixel) [1/px]. If the
  // pixel is the image of no direction, the result is a direction at the edge of the lens's field
  // of view, and project() maps this direction to another pixel. A NaN pixel gives NaN.
  PlanePoint<T> tangents(const Vector2<T>& pixel) const {
    const T inv_fx = T(1) / pinhole.fx, inv_fy = T(1) / pinhole.fy;
    const Vector2<T> d{(pixel.x() - pinhole.cx) * inv_fx, (pixel.y() - pinhole.cy) * inv_fy};
    const PlanePoint<T> e = distortion.straightened(d, field);
    PlanePoint<T> at = distortion.drawn_in(e.point);
    at.by = at.by * e.by;
    at.by.col(0) *= inv_fx;
    at.by.col(1) *= inv_fy;
    return at;
  }
};

}  // namespace axial::refractive
