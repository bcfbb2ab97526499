// SPDX-License-Identifier: GPL-3.0-or-later
// The part of a score that needs cameras, with one pair of plane and source view per SIMD lane:
// projection, warp, smoothness and geometric consistency. This file computes the reference camera's
// rays, too. Only the scorers' translation units include it (lane_scorer.h).
#pragma once

#include <Eigen/Core>

#include "depth/consistency.h"
#include "depth/lanes/lane_depth.h"
#include "depth/lanes/pack.h"
#include "depth/lanes/scorer.h"
#include "refractive/affine_warp.h"

namespace axial::depth::lanes {

// The results of LaneView::look() that the correlation and the cost need.
struct LaneProjections {
  LaneFloats x, y;                 // the patch's centre in the source view [px]
  LaneFloats visible;              // 1 if the source camera sees the patch's centre, else 0
  std::array<LaneFloats, 4> warp;  // d(source pixel)/d(reference pixel), row-major
  LaneFloats depth;                // depth of the plane [m]
  LaneFloats inconsistency;        // geometric term of the cost, times its weight; 0 without maps
};

// Computes with kWidth pairs or pixels at a time. `Camera`: the template of the type of the source
// cameras in `tables`, and for rays() of the reference camera. `Abi`: the ABI of the registers.
// `tables` must outlive the object.
template <template <class> class Camera, class Abi>
class LaneView {
  using T = Pack<Abi>;
  using Vector = refractive::Vector3<T>;
  using Projector = typename Camera<T>::Projector;
  using Image = decltype(std::declval<Projector>().image(std::declval<Vector>()));

  // One source view per lane. If all views have the same projector, `projector` points to this
  // projector, because a copy would take much of the time. Otherwise `projector` points to
  // `gathered`.
  struct Views {
    Projector gathered;
    const Projector* projector;
    refractive::Matrix3<T> rotation;
    Vector translation;
  };

  struct Planes {
    T depth;
    Vector normal;
  };

 public:
  static constexpr std::size_t kWidth = T::kWidth;

  explicit LaneView(const SceneTables& tables) : tables_(tables) {
    fill(reference_, tables.reference.steps,
         [&](std::size_t k) { return T(tables.reference.value[k]); });
    fill(first_projector_, tables.steps, [&](std::size_t k) { return T(tables.projector[k][0]); });
  }

  // Processes kWidth pairs, from pair `first` on. Stores their entries in `projected` and in
  // `scores`, except for the cost. Precondition: `first` is a multiple of kWidth.
  void look(const LanePixel& pixel, const LanePlanes& lane_planes, const LanePairs& pairs,
            std::span<const SurfacePoint> neighbours, std::size_t first, LaneScores& scores,
            LaneProjections& projected) const {
    const Planes planes = gather_planes(lane_planes, Lookup<Abi>(pairs.plane.data() + first));
    const Lookup<Abi> of_view(pairs.view.data() + first);
    Views views;
    gather_views(of_view, views);
    const refractive::AxialRay<T> ray{vector(pixel.origin), vector(pixel.direction)};
    const Vector surface = ray.at(planes.depth);
    depth::smoothness<T>(surface, planes.normal, neighbours, tables_.smoothness)
        .store(scores.smoothness.data() + first);
    const Vector point = views.rotation * surface + views.translation;

    const refractive::Matrix32<T> slide =
        views.rotation *
        refractive::plane_point_derivative(ray, ray_jacobian(pixel), planes.depth, planes.normal);
    const Image image = views.projector->image(point);
    for (int k = 0; k < 2; ++k) {
      const refractive::Vector2<T> column = image.pixel_motion(slide.col(k));
      for (int i = 0; i < 2; ++i)
        column(i).store(projected.warp[static_cast<std::size_t>(2 * i + k)].data() + first);
    }
    image.projection.pixel.x().store(projected.x.data() + first);
    image.projection.pixel.y().store(projected.y.data() + first);
    select(image.projection.visible, T(1), T(0)).store(projected.visible.data() + first);
    planes.depth.store(projected.depth.data() + first);
    T term(0);
    if (!tables_.depths.empty())
      term =
          inconsistency(pixel, ray, planes.depth, pairs.view.data() + first, views, point, image);
    term.store(projected.inconsistency.data() + first);
    const refractive::Vector2<T> motion = image.pixel_motion(views.rotation * ray.direction);
    select(image.projection.visible, sqrt(motion.dot(motion)), T(0))
        .store(scores.motion.data() + first);
  }

  // Computes the rays of the pixels (x, y) to (x + kWidth - 1, y). Stores them in the entries of
  // `rays` from `first` on. Precondition: `first` is a multiple of kWidth.
  void rays(float x, float y, std::size_t first, LaneRays& rays) const {
    T u;
    u.part = typename T::Part([&](auto k) { return x + static_cast<float>(k); });
    refractive::AxialRayJacobian<T> jacobian;
    const refractive::AxialRay<T> ray = reference_.ray({u, T(y)}, jacobian);
    const std::array<Vector, 6> vectors{ray.origin,
                                        ray.direction,
                                        jacobian.origin.col(0),
                                        jacobian.origin.col(1),
                                        jacobian.direction.col(0),
                                        jacobian.direction.col(1)};
    for (std::size_t k = 0; k < rays.size(); ++k)
      vectors[k / 3](static_cast<Eigen::Index>(k % 3)).store(rays[k].data() + first);
  }

 private:
  static Vector vector(const std::array<float, 3>& v) { return {T(v[0]), T(v[1]), T(v[2])}; }

  template <class Fielded, class Field>
  static void fill(Fielded& to, int steps, Field&& value) {
    std::size_t k = 0;
    to.each_field([&](auto& field) {
      if constexpr (std::is_same_v<std::decay_t<decltype(field)>, int>)
        field = steps;
      else
        field = value(k++);
    });
  }

  static refractive::AxialRayJacobian<T> ray_jacobian(const LanePixel& pixel) {
    refractive::AxialRayJacobian<T> jacobian;
    jacobian.origin.col(0) = vector(pixel.origin_u);
    jacobian.origin.col(1) = vector(pixel.origin_v);
    jacobian.direction.col(0) = vector(pixel.direction_u);
    jacobian.direction.col(1) = vector(pixel.direction_v);
    return jacobian;
  }

  static Planes gather_planes(const LanePlanes& planes, const Lookup<Abi>& of) {
    return {of(planes.depth.data()),
            {of(planes.nx.data()), of(planes.ny.data()), of(planes.nz.data())}};
  }

  void gather_views(const Lookup<Abi>& of, Views& views) const {
    views.projector = &first_projector_;
    if (!tables_.same_projector) {
      fill(views.gathered, tables_.steps,
           [&](std::size_t k) { return of(tables_.projector[k].data()); });
      views.projector = &views.gathered;
    }
    for (int i = 0; i < 9; ++i)
      views.rotation(i / 3, i % 3) = of(tables_.rotation[static_cast<std::size_t>(i)].data());
    for (int i = 0; i < 3; ++i)
      views.translation(i) = of(tables_.translation[static_cast<std::size_t>(i)].data());
  }

  // inconsistency() of geometric_check.h times SceneTables::geometric_weight. The result is 0 for
  // views without a depth map.
  T inconsistency(const LanePixel& pixel, const refractive::AxialRay<T>& ray, const T& depth,
                  const std::int32_t* view, const Views& views, const Vector& point,
                  const Image& image) const {
    const T limit(tables_.geometric_limit);
    // The projection is exact, so `point` lies on the ray of image.projection.pixel.
    const Vector along = point - image.origin();
    const T expected = sqrt(along.dot(along));
    const T found = lane_depth_near(tables_.depths.data(), lane_images<Abi>(tables_, view),
                                    image.projection, expected);
    const Vector shift = views.rotation.transpose() * (along * (found / expected - T(1)));
    const T term =
        inconsistency_term(shift_in_pixels(ray, ray_jacobian(pixel), depth, shift), limit);
    const T has = Lookup<Abi>(view)(tables_.has_depth.data());
    return T(tables_.geometric_weight) * has * select(found > T(0), term, limit);
  }

  const SceneTables& tables_;
  Camera<T> reference_;
  Projector first_projector_;
};

}  // namespace axial::depth::lanes
