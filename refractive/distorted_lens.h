// SPDX-License-Identifier: GPL-3.0-or-later
// A lens with distortion: between pixels and tangents, the direction in air (u, v, 1).
#pragma once

#include "refractive/lens_field.h"

namespace axial::refractive {

template <class T>
struct DistortedLens {
  PinholeLens<T> pinhole;  // focal lengths and principal point [px]
  LensDistortion<T> distortion;
  T field = T(0);         // the lens is defined for |e| up to this (lens_field.h)
  WidenedImage<T> image;  // what is projected

  DistortedLens() = default;  // means nothing before each_field() has filled it

  // width, height, margin: as FlatPortCamera's.
  DistortedLens(const PinholeLens<double>& lens, const LensDistortion<double>& bends, int width,
                int height, int margin = -1)
      : pinhole(lens.cast<T>()), distortion(bends.template cast<T>()) {
    const double widened = WidenedImage<double>::margin_or_default(width, height, margin);
    field = static_cast<T>(lens_field(lens, bends, {width, height, widened}));
    image = {width, height, static_cast<T>(widened)};
  }

  // False where no direction is imaged at the pixel: it lies beyond the lens's field.
  bool shows(const Vector2<T>& pixel) const {
    const Vector2<T> found = project(tangents(pixel).point).projection.pixel;
    return (found - pixel).squaredNorm() < T(1e-4);
  }

  // True if the corners of the image of width x height are shown, beyond which no pixel lies.
  bool shows_all(int width, int height) const {
    bool all = true;
    for (const T& u : {T(0), T(width - 1)})
      for (const T& v : {T(0), T(height - 1)}) all = all && shows({u, v});
    return all;
  }

  // See FlatPortCamera.
  template <class Visit>
  void each_field(Visit&& visit) {
    visit(pinhole.fx), visit(pinhole.fy), visit(pinhole.cx), visit(pinhole.cy);
    distortion.each_field(visit);
    visit(field);
    image.each_field(visit);
  }

  // The image of a direction in air. Not visible: beyond the lens's field or outside the widened
  // image. `by`: d(pixel)/d(tangents). Everything is finite for finite tangents.
  struct Image {
    Projection<T> projection;
    Matrix2<T> by;
  };
  Image project(const Vector2<T>& tangents) const {
    const PlanePoint<T> e = distortion.spread_out(tangents);
    const Mask<T> defined = e.point.x() * e.point.x() + e.point.y() * e.point.y() <= field * field;
    // Far outside the polynomials leave single precision's range.
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

  // The tangents a pixel sees, and d(tangents)/d(pixel). Pixels that no direction is imaged at get
  // one at the edge of the lens's field, which projects elsewhere. NaN in, NaN out.
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
