// SPDX-License-Identifier: BSD-3-Clause
// A camera whose lens has distortion, without a port, or behind a flat port or a dome. The camera
// combines two parts. A DistortedLens maps tangents in air to pixels. An inner camera of this
// folder, whose lens has no distortion, maps points to tangents: the "pixels" of the inner camera
// are tangents in air. The chain rule gives the derivatives.
#pragma once

#include <utility>

#include "refractive/distorted_lens.h"
#include "refractive/dome_port_camera.h"
#include "refractive/flat_port_camera.h"

namespace axial::refractive {

// The image of a point, and the derivative of the pixel by the point. Points are in the frame of
// the inner projector, the projector of the inner camera.
template <class T, class InnerImage>
struct LensImage {
  Projection<T> projection;

  // The origin of the ray through the point [frame of the inner projector, m].
  Vector3<T> origin() const { return inner.origin(); }

  // First-order motion of the pixel [px] when the point moves by `step` [frame of the inner
  // projector, m].
  Vector2<T> pixel_motion(const Vector3<T>& step) const {
    return by_tangents * inner.pixel_motion(step);
  }

  InnerImage inner;        // the inner camera's image, in tangents
  Matrix2<T> by_tangents;  // d(pixel)/d(tangents) [px]
};

// The part of a LensCamera that projects points.
template <class T, class InnerProjector>
class LensProjector {
 public:
  LensProjector() = default;  // invalid until each_field() has filled it
  LensProjector(const DistortedLens<T>& lens, const InnerProjector& inner)
      : lens_(lens), inner_(inner) {}

  // Calls visit(number) for every number of the projector, in a fixed order. The SIMD code uses it
  // as it uses FlatPortCamera::each_field().
  template <class Visit>
  void each_field(Visit&& visit) {
    lens_.each_field(visit);
    inner_.each_field(visit);
  }

  // The image of X [frame of the inner projector, m]. LensCamera::project states when X is visible.
  // Every number of the result is finite, for every X. The numbers are meaningless if X is not
  // visible.
  auto image(const Vector3<T>& X) const {
    LensImage<T, decltype(inner_.image(X))> image;
    image.inner = inner_.image(X);
    const auto seen = lens_.project(image.inner.projection.pixel);
    image.by_tangents = seen.by;
    image.projection = seen.projection;
    image.projection.visible = image.inner.projection.visible && seen.projection.visible;
    return image;
  }

 private:
  DistortedLens<T> lens_;
  InnerProjector inner_;
};

// The lens of the inner camera: it maps the direction (u, v, 1) to the pixel (u, v).
template <class T>
PinholeLens<T> tangent_lens() {
  return {T(1), T(1), T(0), T(0)};
}

// The image rectangle of the inner camera, in tangents. It is so large that it excludes no
// direction. The DistortedLens tests whether a pixel lies in the real image rectangle.
template <class T>
WidenedImage<T> all_tangents() {
  return {1, 1, T(1e6)};
}

namespace detail {

// Returns the tangent of the largest angle of incidence on the port in air, over `image` [px]. The
// result is about 0.2% too large, as a reserve between the samples, and is at least 0.001 and at
// most 50. The result is 50 if a sampled pixel looks parallel to the port or away from the port.
// Only the border of `image` is sampled, because the incidence grows towards the border.
template <class T>
T largest_incidence_tangent(const DistortedLens<T>& lens, const FlatPort<T>& port,
                            const WidenedImage<T>& image) {
  using std::sqrt;
  constexpr int kSamples = 64;
  constexpr float kBetween = 1.002f;  // bound of the tangent's growth between two samples
  const T kGrazing(50);
  T largest = T(1e-3);
  const auto look = [&](const T& u, const T& v) {
    const Vector2<T> at = lens.tangents({u, v}).point;
    const Vector3<T> bearing(at.x(), at.y(), T(1));
    const T along = bearing.dot(port.normal);
    const T across2 = (bearing - along * port.normal).squaredNorm();
    if (!(along > T(0)) || across2 > kGrazing * kGrazing * along * along)
      largest = kGrazing;
    else if (across2 > largest * largest * along * along)
      largest = sqrt(across2) / along;
  };
  for (int k = 0; k <= kSamples; ++k) {
    const T share = T(k) / T(kSamples);
    const T u = image.lowest + share * (image.highest_u - image.lowest);
    const T v = image.lowest + share * (image.highest_v - image.lowest);
    look(u, image.lowest), look(u, image.highest_v);
    look(image.lowest, v), look(image.highest_u, v);
  }
  return lesser(T(kBetween) * largest, kGrazing);
}

template <class T>
PinholeCamera<T> inner_camera(const DistortedLens<T>&) {
  return PinholeCamera<T>(tangent_lens<T>());
}

template <class T>
FlatPortCamera<T> inner_camera(const DistortedLens<T>& lens, const FlatPort<T>& port) {
  const T margin = -lens.image.lowest;
  WidenedImage<T> bare = lens.image;
  bare.lowest = T(0), bare.highest_u -= margin, bare.highest_v -= margin;
  const T widest = largest_incidence_tangent(lens, port, lens.image);
  const T promised = lesser(widest, largest_incidence_tangent(lens, port, bare));
  return {tangent_lens<T>(), port, FlatPortField<T>(FlatPortOptics<T>(port), widest, promised),
          all_tangents<T>()};
}

template <class T>
DomePortCamera<T> inner_camera(const DistortedLens<T>&, const DomePort<T>& port) {
  return {tangent_lens<T>(), port, all_tangents<T>()};
}

}  // namespace detail

// A camera with a distorted lens. `Inner`: PinholeCamera, FlatPortCamera or DomePortCamera.
template <class Inner>
class LensCamera {
 public:
  using Scalar = typename Inner::Scalar;
  using T = Scalar;

  LensCamera() = default;  // invalid until each_field() has filled it

  // The first constructor is for Inner = PinholeCamera, a camera without a port. The second
  // constructor is for a camera behind `port`: a FlatPort for Inner = FlatPortCamera, a DomePort
  // for Inner = DomePortCamera. The preconditions of the port are not checked.
  explicit LensCamera(const DistortedLens<T>& lens)
      : lens_(lens), inner_(detail::inner_camera(lens)) {}
  template <class Port>
  LensCamera(const DistortedLens<T>& lens, const Port& port)
      : lens_(lens), inner_(detail::inner_camera(lens, port)) {}

  // Calls visit(number) for every number of the camera, in a fixed order. The SIMD code uses it as
  // it uses FlatPortCamera::each_field().
  template <class Visit>
  void each_field(Visit&& visit) {
    lens_.each_field(visit);
    inner_.each_field(visit);
  }

  const DistortedLens<T>& distorted_lens() const { return lens_; }
  const Inner& inner() const { return inner_; }

  // The ray of `pixel` in the scene medium, in the camera frame. If the pixel is the image of no
  // direction, the result is the ray of a direction at the edge of the lens's field of view. A NaN
  // pixel gives a ray with a NaN direction.
  AxialRay<T> ray(const Vector2<T>& pixel) const { return inner_.ray(lens_.tangents(pixel).point); }

  // The ray of `pixel`, as above. `jacobian` receives the derivatives of the ray by the pixel.
  AxialRay<T> ray(const Vector2<T>& pixel, AxialRayJacobian<T>& jacobian) const {
    const PlanePoint<T> tangents = lens_.tangents(pixel);
    AxialRayJacobian<T> by_tangents;
    const AxialRay<T> ray = inner_.ray(tangents.point, by_tangents);
    jacobian.origin = by_tangents.origin * tangents.by;
    jacobian.direction = by_tangents.direction * tangents.by;
    return ray;
  }

  // The point at which the ray of `pixel` enters the scene medium [camera frame, m]. Without a
  // port: the camera centre.
  Vector3<T> exit_point(const Vector2<T>& pixel) const {
    return inner_.exit_point(lens_.tangents(pixel).point);
  }

  // The part of the camera that projects points. It takes points in the frame of the inner
  // projector. projector_frame() is the transformation from the camera frame to this frame.
  using Projector = LensProjector<T, typename Inner::Projector>;
  Projector projector() const { return {lens_, inner_.projector()}; }
  RigidTransform<T> projector_frame() const { return inner_.projector_frame(); }

  // Exact forward projection of X [camera frame, m]. `jacobian` receives d(pixel)/dX [px/m].
  // `origin` receives the origin of the ray through X [camera frame, m]. Both pointers may be null.
  // X is visible if all three conditions hold:
  //   - X is visible to the inner camera (see Inner::project()).
  //   - The direction in air in which the lens sees X lies within the lens's field.
  //   - The pixel lies in the widened image of the lens.
  // The numbers of a point that is not visible are finite but meaningless.
  Projection<T> project(const Vector3<T>& X, Matrix23<T>* jacobian = nullptr,
                        Vector3<T>* origin = nullptr) const {
    Matrix23<T> by_point;
    const Projection<T> tangents = inner_.project(X, jacobian ? &by_point : nullptr, origin);
    const auto seen = lens_.project(tangents.pixel);
    if (jacobian) *jacobian = seen.by * by_point;
    return {seen.projection.pixel, tangents.visible && seen.projection.visible};
  }

 private:
  DistortedLens<T> lens_;
  Inner inner_;
};

template <class T>
using LensPinholeCamera = LensCamera<PinholeCamera<T>>;
template <class T>
using LensFlatPortCamera = LensCamera<FlatPortCamera<T>>;
template <class T>
using LensDomePortCamera = LensCamera<DomePortCamera<T>>;

}  // namespace axial::refractive
