// SPDX-License-Identifier: GPL-3.0-or-later
// A lens with distortion in front of nothing, a flat port or a dome: any camera of this folder with
// a straight lens, whose "pixels" are tangents in air, seen through the lens. Rays, projections and
// derivatives are the inner camera's, by the chain rule.
#pragma once

#include <utility>

#include "refractive/distorted_lens.h"
#include "refractive/dome_port_camera.h"
#include "refractive/flat_port_camera.h"

namespace axial::refractive {

// A point's image and how it moves with the point.
template <class T, class InnerImage>
struct LensImage {
  Projection<T> projection;

  // Where the ray through the point begins.
  Vector3<T> origin() const { return inner.origin(); }

  // The pixel's motion [px] with a motion of the point [m], to first order.
  Vector2<T> moved(const Vector3<T>& step) const { return by_tangents * inner.moved(step); }

  InnerImage inner;        // in tangents
  Matrix2<T> by_tangents;  // d(pixel)/d(tangents)
};

template <class T, class InnerProjector>
class LensProjector {
 public:
  LensProjector() = default;  // means nothing before each_field() has filled it
  LensProjector(const DistortedLens<T>& lens, const InnerProjector& inner)
      : lens_(lens), inner_(inner) {}

  // See FlatPortCamera.
  template <class Visit>
  void each_field(Visit&& visit) {
    lens_.each_field(visit);
    inner_.each_field(visit);
  }

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

namespace detail {

template <class T>
PinholeLens<T> tangent_lens() {
  return {T(1), T(1), T(0), T(0)};
}

// Larger than any image of tangents; what is outside is the lens's to say.
template <class T>
WidenedImage<T> all_tangents() {
  return {1, 1, T(1e6)};
}

// The largest in-air incidence on the port over an image's border, inside which it grows towards.
template <class T>
T largest_incidence_tangent(const DistortedLens<T>& lens, const FlatPort<T>& port,
                            const WidenedImage<T>& image) {
  using std::sqrt;
  constexpr int kSamples = 64;
  constexpr float kBetween = 1.002f;  // more than incidences grow between samples
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

// `Inner` is one of the cameras with a straight lens.
template <class Inner>
class LensCamera {
 public:
  using Scalar = typename Inner::Scalar;
  using T = Scalar;

  LensCamera() = default;  // means nothing before each_field() has filled it

  // A dry camera, or one behind the port that Inner has.
  explicit LensCamera(const DistortedLens<T>& lens)
      : lens_(lens), inner_(detail::inner_camera(lens)) {}
  template <class Port>
  LensCamera(const DistortedLens<T>& lens, const Port& port)
      : lens_(lens), inner_(detail::inner_camera(lens, port)) {}

  // As FlatPortCamera::each_field.
  template <class Visit>
  void each_field(Visit&& visit) {
    lens_.each_field(visit);
    inner_.each_field(visit);
  }

  const DistortedLens<T>& distorted_lens() const { return lens_; }
  const Inner& inner() const { return inner_; }

  // The inner camera's, of a pixel that the lens images no direction at one of the edge of its
  // field.
  AxialRay<T> ray(const Vector2<T>& pixel) const { return inner_.ray(lens_.tangents(pixel).point); }

  AxialRay<T> ray(const Vector2<T>& pixel, AxialRayJacobian<T>& jacobian) const {
    const PlanePoint<T> tangents = lens_.tangents(pixel);
    AxialRayJacobian<T> by_tangents;
    const AxialRay<T> ray = inner_.ray(tangents.point, by_tangents);
    jacobian.origin = by_tangents.origin * tangents.by;
    jacobian.direction = by_tangents.direction * tangents.by;
    return ray;
  }

  Vector3<T> exit_point(const Vector2<T>& pixel) const {
    return inner_.exit_point(lens_.tangents(pixel).point);
  }

  using Projector = LensProjector<T, typename Inner::Projector>;
  Projector projector() const { return {lens_, inner_.projector()}; }
  Frame<T> projector_frame() const { return inner_.projector_frame(); }

  // As the inner camera's; not visible is also what is beyond the lens's field.
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
