// SPDX-License-Identifier: GPL-3.0-or-later
// The scorer for one instruction set. To be included by its translation unit alone.
#pragma once

#include <Eigen/Core>

#include "depth/lanes/lane_zncc.h"
#include "depth/lanes/pack.h"
#include "depth/lanes/scorer.h"
#include "depth/reference_patch.h"
#include "refractive/affine_warp.h"
#include "refractive/flat_port_camera.h"

// Everything stays in registers only where no call lies between. Under the sanitizers that would be
// one enormous function, which takes minutes to compile.
#ifdef __SANITIZE_ADDRESS__
#define AXIAL_FLATTEN
#else
#define AXIAL_FLATTEN [[gnu::flatten]]
#endif

namespace axial::depth::lanes {

template <template <class> class Camera, class Abi>
class LaneScorer final : public Scorer {
  using T = Pack<Abi>;
  using Vector = refractive::Vector3<T>;
  using Ints = typename T::Ints;

  // A source view in every lane.
  struct Views {
    Camera<T> camera;
    refractive::Matrix3<T> rotation;
    Vector translation;
    LaneImages<Abi> image;
  };

  struct Planes {
    T depth;
    Vector normal;
  };

 public:
  explicit LaneScorer(const SceneTables& tables) : tables_(tables) {
    fill(reference_, tables.reference.steps,
         [&](std::size_t k) { return T(tables.reference.value[k]); });
    fill(first_source_, tables.steps, [&](std::size_t k) { return T(tables.camera[k][0]); });
  }

  void score(const LanePixel& pixel, const LanePlanes& planes, const LanePairs& pairs,
             std::span<const SurfacePoint> neighbours, LaneScores& scores) const override {
    for (std::size_t first = 0; first < pairs.count; first += T::kWidth)
      score_pack(pixel, planes, pairs, neighbours, first, scores);
  }

 private:
  // The pairs from `first` on, as many as a pack holds.
  AXIAL_FLATTEN void score_pack(const LanePixel& pixel, const LanePlanes& lane_planes,
                                const LanePairs& pairs, std::span<const SurfacePoint> neighbours,
                                std::size_t first, LaneScores& scores) const {
    const Planes planes = deal_planes(lane_planes, Lookup<Abi>(pairs.plane.data() + first));
    const Lookup<Abi> of_view(pairs.view.data() + first);
    const Views views = deal_views(of_view, pairs.view.data() + first);
    const refractive::AxialRay<T> ray{vector(pixel.origin), vector(pixel.direction)};
    const Vector surface = ray.at(planes.depth);
    depth::smoothness<T>(surface, planes.normal, neighbours, tables_.smoothness)
        .store(scores.smoothness.data() + first);
    const Vector point = views.rotation * surface + views.translation;

    refractive::Matrix23<T> jacobian;
    Vector origin;
    const refractive::Projection<T> image = views.camera.project(point, &jacobian, &origin);
    const refractive::Matrix2<T> warp = refractive::warp_derivative(
        jacobian, views.rotation,
        refractive::plane_point_derivative(ray, ray_jacobian(pixel), planes.depth, planes.normal));

    const T correlation = lane_zncc(*pixel.patch, tables_.words.data(), views.image, image, warp);
    T cost = select(correlation < T(-1.5f), T(kOutsideCost), T(1) - correlation);
    if (!tables_.depths.empty()) cost += inconsistency(pixel, of_view, views, point, image, origin);
    if (pixel.prior_weight > 0) {
      const T off = abs(planes.depth - T(pixel.prior_depth)) / T(pixel.prior_depth);
      cost += T(pixel.prior_weight) * (min(off, T(0.5f)) - cost);
    }
    min(cost, T(kMaxCost)).store(scores.cost.data() + first);
    const refractive::Vector2<T> motion = jacobian * (views.rotation * ray.direction);
    select(image.visible, sqrt(motion.dot(motion)), T(0)).store(scores.motion.data() + first);
  }

  static Vector vector(const std::array<float, 3>& v) { return {T(v[0]), T(v[1]), T(v[2])}; }

  template <class Field>
  static void fill(Camera<T>& camera, int steps, Field&& value) {
    std::size_t k = 0;
    camera.each_field([&](auto& field) {
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

  static Planes deal_planes(const LanePlanes& planes, const Lookup<Abi>& of) {
    return {of(planes.depth.data()),
            {of(planes.nx.data()), of(planes.ny.data()), of(planes.nz.data())}};
  }

  Views deal_views(const Lookup<Abi>& of, const std::int32_t* view) const {
    Views views;
    if (tables_.same_camera)
      views.camera = first_source_;
    else
      fill(views.camera, tables_.steps,
           [&](std::size_t k) { return of(tables_.camera[k].data()); });
    for (int i = 0; i < 9; ++i)
      views.rotation(i / 3, i % 3) = of(tables_.rotation[static_cast<std::size_t>(i)].data());
    for (int i = 0; i < 3; ++i)
      views.translation(i) = of(tables_.translation[static_cast<std::size_t>(i)].data());
    views.image.width = of(tables_.width.data());
    views.image.height = of(tables_.height.data());
    views.image.begin =
        Ints([&](auto k) { return tables_.image_begin[static_cast<std::size_t>(view[k])]; });
    return views;
  }

  // The term of geometric_check.h, times its weight.
  T inconsistency(const LanePixel& pixel, const Lookup<Abi>& of_view, const Views& views,
                  const Vector& point, const refractive::Projection<T>& image,
                  const Vector& origin) const {
    const T limit(tables_.geometric_limit);
    const Vector along = point - origin;  // the ray of image.pixel, because that is exact
    const T expected = sqrt(along.dot(along));
    const T found = lane_depth_near(tables_.depths.data(), views.image, image, expected);
    const Vector seen = origin + along * (found / expected);
    const Vector back = views.rotation.transpose() * (seen - views.translation);
    const refractive::Projection<T> backward = reference_.project(back);
    const T du = backward.pixel.x() - T(pixel.at[0]);
    const T dv = backward.pixel.y() - T(pixel.at[1]);
    const T error = sqrt(du * du + dv * dv);
    const T term = min(sqrt(error * (error + T(2))), limit);
    const T has = of_view(tables_.has_depth.data());
    return T(tables_.geometric_weight) * has *
           select(found > T(0) && backward.visible, term, limit);
  }

  const SceneTables& tables_;
  Camera<T> reference_, first_source_;
};

template <class Abi>
std::unique_ptr<Scorer> make_lane_scorer(const SceneTables& tables) {
  if (tables.kind == CameraKind::pinhole)
    return std::make_unique<LaneScorer<refractive::PinholeCamera, Abi>>(tables);
  return std::make_unique<LaneScorer<refractive::FlatPortCamera, Abi>>(tables);
}

}  // namespace axial::depth::lanes
