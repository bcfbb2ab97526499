// SPDX-License-Identifier: BSD-3-Clause
// The image rectangle, widened by a margin on every side. A point is visible to a camera behind a
// port, or through a lens with distortion, only if its pixel lies in this rectangle.
#pragma once

#include "refractive/axial_ray.h"

namespace axial::refractive {

template <class T>
struct WidenedImage {
  // Limits [px]: `lowest` of u and of v, `highest_u` of u, `highest_v` of v.
  T lowest, highest_u, highest_v;

  WidenedImage() = default;  // the limits have no values
  // `width`, `height`: size of the image [px]. `margin` [px]: widening on every side. A negative
  // margin makes the rectangle smaller than the image.
  WidenedImage(int width, int height, const T& margin)
      : lowest(-margin), highest_u(T(width - 1) + margin), highest_v(T(height - 1) + margin) {}

  // Returns `margin` if it is not negative, otherwise the default: an eighth of the longer side,
  // rounded down.
  static T margin_or_default(int width, int height, int margin) {
    return T(margin >= 0 ? margin : (width > height ? width : height) / 8);
  }

  // Calls visit(number) for every limit, in a fixed order. The SIMD code uses it as it uses
  // FlatPortCamera::each_field().
  template <class Visit>
  void each_field(Visit&& visit) {
    visit(lowest), visit(highest_u), visit(highest_v);
  }

  // True if `pixel` lies inside the rectangle or on its edge. False for NaN.
  Mask<T> contains(const Vector2<T>& pixel) const {
    return pixel.x() >= lowest && pixel.x() <= highest_u && pixel.y() >= lowest &&
           pixel.y() <= highest_v;
  }
};

}  // namespace axial::refractive
