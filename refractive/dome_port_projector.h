// SPDX-License-Identifier: BSD-3-Clause
// The exact forward projection through a dome port. Camera frame, metres. The symbols are those of
// dome_port.h.
//
// Let r be the unit direction in air of the pixel that images X. r lies in the plane through X and
// the axis. So r is a function of one unknown, zeta:
//
//     r = (d - zeta C) / N         with d = X/|X| and N = |d - zeta C|
//
// The ray from C_v with direction D = Q r - S C passes through X if
//
//     h(zeta) = zeta - (1 - 1/(mu_w Q)) / |X| + S N / Q = 0.
//
// zeta [1/m] is small. Therefore h is nearly linear in zeta.
#pragma once

#include <cmath>

#include "refractive/dome_port.h"
#include "refractive/pinhole_camera.h"
#include "refractive/widened_image.h"

namespace axial::refractive {

// The image of a point, and the derivative of the pixel by the point. Points are in the camera
// frame.
template <class T>
struct DomePortImage {
  Projection<T> projection;

  // The origin of the ray through the point: the virtual centre C_v [camera frame, m].
  Vector3<T> origin() const { return origin_share * centre; }

  // First-order motion of the pixel [px] when the point moves by `step` [camera frame, m].
  Vector2<T> pixel_motion(const Vector3<T>& step) const {
    const T along = towards.dot(step);
    const Vector3<T> turn = inv_range * (step - along * towards);
    const T zeta = zeta_by_cosine * centre.dot(turn) - zeta_by_inv_range * along;
    return in_air.pixel_motion(turn - zeta * centre);
  }

  Vector3<T> towards, centre;  // d and C
  T origin_share;              // 1 - 1/(mu_w Q)
  T inv_range;                 // 1/|X|
  T zeta_by_cosine;            // d(zeta)/d(d.C)
  T zeta_by_inv_range;         // d(zeta)/d(1/|X|) / |X|^2
  PinholeImage<T> in_air;      // the pinhole image of d - zeta C, taken as a point
};

// The part of a DomePortCamera that projects points.
template <class T>
class DomePortProjector {
 public:
  DomePortProjector() = default;  // invalid until each_field() has filled it

  // `lens`: the lens in air. `image` [px]: the rectangle that must contain the pixel of a visible
  // point. The preconditions of DomePort are not checked.
  DomePortProjector(const PinholeLens<T>& lens, const DomePort<T>& port,
                    const WidenedImage<T>& image)
      : optics_(port), in_air_(lens), image_(image), steps_(steps_for(optics_)) {}

  // Calls visit(number) for every number of the projector, in a fixed order. The SIMD code uses it
  // as it uses FlatPortCamera::each_field().
  template <class Visit>
  void each_field(Visit&& visit) {
    optics_.each_field(visit);
    in_air_.each_field(visit);
    image_.each_field(visit);
    visit(steps_);
  }

  const DomePortOptics<T>& optics() const { return optics_; }

  // The image of X [camera frame, m]. DomePortCamera::project states when X is visible. Every
  // number of the result is finite, for every X. The numbers are meaningless if X is not visible.
  DomePortImage<T> image(const Vector3<T>& X) const {
    using std::sqrt;
    const Vector3<T>& C = optics_.centre;
    const T from_centre2 = (X - C).squaredNorm();
    // False for NaN. The upper bound keeps squares within the range of single precision.
    const Mask<T> in_water = from_centre2 > optics_.outer_radius * optics_.outer_radius &&
                             from_centre2 < T(kFarthest * kFarthest);
    DomePortImage<T> image;
    // A point outside the water is replaced by (0, 0, 1), so that all results are finite.
    const Vector3<T> safe{select(in_water, X.x(), T(0)), select(in_water, X.y(), T(0)),
                          select(in_water, X.z(), T(1))};
    image.inv_range = T(1) / sqrt(safe.squaredNorm());
    image.towards = image.inv_range * safe;
    image.centre = C;
    const Root at = solve(image.towards.dot(C), image.inv_range);
    image.zeta_by_cosine = at.zeta_by_cosine;
    image.zeta_by_inv_range = at.zeta_by_inv_range * image.inv_range * image.inv_range;
    image.origin_share = at.origin_share;

    image.in_air = in_air_.image(image.towards - at.zeta * C);
    image.projection = image.in_air.projection;
    image.projection.visible =
        in_water && image.projection.visible && image_.contains(image.projection.pixel);
    return image;
  }

 private:
  static constexpr float kFarthest = 1e9f;  // a million kilometres

  struct Root {
    T zeta, zeta_by_cosine, zeta_by_inv_range, origin_share;
  };

  // The value h, the derivatives of h by zeta and by c = d.C, and 1/Q.
  struct Slopes {
    T h, by_zeta, by_cosine, inv_q;

    Slopes(const DomePortOptics<T>& optics, const T& zeta, const T& c, const T& inv_range) {
      using std::sqrt;
      const T C2 = optics.centre2;
      const T across = c - zeta * C2;
      const T norm = sqrt(T(1) - zeta * (c + across));
      const T inv_norm = T(1) / norm;
      const T p = across * inv_norm;  // r.C
      const T k2 = (C2 - c * c) * inv_norm * inv_norm;
      const DomeTurn<T> turn = optics.turn(k2);
      const T q = turn.cosine + p * turn.sine;
      inv_q = T(1) / q;
      const T ratio = turn.sine * norm * inv_q;
      h = zeta - (T(1) - optics.inv_mu * inv_q) * inv_range + ratio;

      // Derivative of S N / Q - (1 - 1/(mu_w Q)) / |X| by a variable. The arguments are the
      // derivatives of N, k^2 and p = r.C by the same variable.
      const auto slope = [&](const T& dnorm, const T& dk2, const T& dp) {
        const T dsine = turn.sine_slope * dk2;
        const T dq = turn.cosine_slope * dk2 + p * dsine + turn.sine * dp;
        return (dsine * norm + turn.sine * dnorm -
                dq * (ratio + optics.inv_mu * inv_q * inv_range)) *
               inv_q;
      };
      const T norm_by_c = -zeta * inv_norm;
      by_zeta = T(1) + slope(-p, T(2) * k2 * p * inv_norm, (p * p - C2) * inv_norm);
      by_cosine = slope(norm_by_c, T(-2) * (c * inv_norm + k2 * norm_by_c) * inv_norm,
                        (T(1) - p * norm_by_c) * inv_norm);
    }
  };

  Root solve(const T& c, const T& inv_range) const {
    T zeta = guess(c, inv_range);
    if constexpr (kFixedSteps<T>) {
      for (int step = 1; step < steps_; ++step) {
        const Slopes at(optics_, zeta, c, inv_range);
        zeta -= at.h / at.by_zeta;
      }
    } else {
      for (int step = 0; step < 30; ++step) {
        const Slopes at(optics_, zeta, c, inv_range);
        const T next = zeta - at.h / at.by_zeta;
        const bool still = !(next != zeta);
        zeta = next;
        if (still) break;
      }
    }
    // This last step is needed by automatic-differentiation scalars: it sets their derivatives.
    const Slopes at(optics_, zeta, c, inv_range);
    const T inv = T(1) / at.by_zeta;
    return {zeta - at.h * inv, -at.by_cosine * inv, (T(1) - optics_.inv_mu * at.inv_q) * inv,
            T(1) - optics_.inv_mu * at.inv_q};
  }

  // The first guess of zeta: the solution of h(zeta) = 0 with k = 0 and N = 1, as for a ray near
  // the axis.
  T guess(const T& c, const T& inv_range) const {
    const T sine = optics_.axial_sine();
    const T inv_q = T(1) / (T(1) + c * sine);
    return (T(1) - optics_.inv_mu * inv_q) * inv_range - sine * inv_q;
  }

  // The number of steps in single precision. This number keeps the errors below 1e-4 px in an
  // image of 1024 px width. The number grows with the decentring |C| / inner_radius.
  static int steps_for(const DomePortOptics<T>& optics) {
    const T decentring2 = optics.centre2 * optics.in_air * optics.in_air;
    return decentring2 < T(0.01) ? 1 : (decentring2 < T(0.16) ? 2 : 4);
  }

  DomePortOptics<T> optics_;
  PinholeCamera<T> in_air_;
  WidenedImage<T> image_;
  int steps_;
};

}  // namespace axial::refractive
