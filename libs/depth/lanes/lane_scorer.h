// SPDX-License-Identifier: GPL-3.0-or-later
// The scorer for one instruction set. To be included by its translation unit alone.
#pragma once

#include <Eigen/Core>

#include "depth/consistency.h"
#include "depth/lanes/lane_zncc.h"
#include "depth/lanes/pack.h"
#include "depth/lanes/scorer.h"
#include "depth/reference_patch.h"
#include "refractive/affine_warp.h"
#include "refractive/dome_port_camera.h"
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
  using Projector = typename Camera<T>::Projector;
  using Image = decltype(std::declval<Projector>().image(std::declval<Vector>()));

  // A source view in every lane. Where all have the same projector, that one is referred to:
  // copying it would be a good part of the work.
  struct Views {
    Projector dealt;
    const Projector* projector;
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
    fill(first_projector_, tables.steps, [&](std::size_t k) { return T(tables.projector[k][0]); });
  }

  // Looks with all packs before it compares with any: projecting is one long chain of operations
  // that wait for each other, and the processor fills the waits of one pack with another's work.
  AXIAL_FLATTEN void score(const LanePixel& pixel, const LanePlanes& planes, const LanePairs& pairs,
                           std::span<const SurfacePoint> neighbours,
                           LaneScores& scores) const override {
    std::array<Seen, kLanes / T::kWidth> seen;
    for (std::size_t first = 0; first < pairs.count; first += T::kWidth)
      look(pixel, planes, pairs, neighbours, first, scores, seen[first / T::kWidth]);
    for (std::size_t first = 0; first < pairs.count; first += T::kWidth)
      compare(pixel, seen[first / T::kWidth], first, scores);
  }

  void rays(float x, float y, LaneRays& rays) const override {
    for (std::size_t first = 0; first < kLanes; first += T::kWidth)
      ray_pack(x + static_cast<float>(first), y, first, rays);
  }

 private:
  AXIAL_FLATTEN void ray_pack(float x, float y, std::size_t first, LaneRays& rays) const {
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

  // How the source views see the planes: all that is known before any texel is read.
  struct Seen {
    LaneImages<Abi> image;
    refractive::Projection<T> centre;
    refractive::Matrix2<T> warp;
    T depth, inconsistency;
  };

  // The pairs from `first` on, as many as a pack holds. Stores all scores but the cost.
  void look(const LanePixel& pixel, const LanePlanes& lane_planes, const LanePairs& pairs,
            std::span<const SurfacePoint> neighbours, std::size_t first, LaneScores& scores,
            Seen& seen) const {
    const Planes planes = deal_planes(lane_planes, Lookup<Abi>(pairs.plane.data() + first));
    const Lookup<Abi> of_view(pairs.view.data() + first);
    Views views;
    deal_views(of_view, pairs.view.data() + first, views);
    const refractive::AxialRay<T> ray{vector(pixel.origin), vector(pixel.direction)};
    const Vector surface = ray.at(planes.depth);
    depth::smoothness<T>(surface, planes.normal, neighbours, tables_.smoothness)
        .store(scores.smoothness.data() + first);
    const Vector point = views.rotation * surface + views.translation;

    const refractive::Matrix32<T> slide =
        views.rotation *
        refractive::plane_point_derivative(ray, ray_jacobian(pixel), planes.depth, planes.normal);
    const Image image = views.projector->image(point);
    for (int k = 0; k < 2; ++k) seen.warp.col(k) = image.moved(slide.col(k));
    seen.image = views.image;
    seen.centre = image.projection;
    seen.depth = planes.depth;
    seen.inconsistency = T(0);
    if (!tables_.depths.empty())
      seen.inconsistency = inconsistency(pixel, ray, planes.depth, of_view, views, point, image);
    const refractive::Vector2<T> motion = image.moved(views.rotation * ray.direction);
    select(image.projection.visible, sqrt(motion.dot(motion)), T(0))
        .store(scores.motion.data() + first);
  }

  void compare(const LanePixel& pixel, const Seen& seen, std::size_t first,
               LaneScores& scores) const {
    const T correlation =
        lane_zncc(*pixel.patch, tables_.words.data(), seen.image, seen.centre, seen.warp);
    T cost = select(correlation < T(-1.5f), T(kOutsideCost), T(1) - correlation);
    cost += seen.inconsistency;
    if (pixel.prior_weight > 0) {
      const T off = abs(seen.depth - T(pixel.prior_depth)) / T(pixel.prior_depth);
      cost += T(pixel.prior_weight) * (min(off, T(0.5f)) - cost);
    }
    min(cost, T(kMaxCost)).store(scores.cost.data() + first);
  }

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

  static Planes deal_planes(const LanePlanes& planes, const Lookup<Abi>& of) {
    return {of(planes.depth.data()),
            {of(planes.nx.data()), of(planes.ny.data()), of(planes.nz.data())}};
  }

  void deal_views(const Lookup<Abi>& of, const std::int32_t* view, Views& views) const {
    views.projector = &first_projector_;
    if (!tables_.same_projector) {
      fill(views.dealt, tables_.steps,
           [&](std::size_t k) { return of(tables_.projector[k].data()); });
      views.projector = &views.dealt;
    }
    for (int i = 0; i < 9; ++i)
      views.rotation(i / 3, i % 3) = of(tables_.rotation[static_cast<std::size_t>(i)].data());
    for (int i = 0; i < 3; ++i)
      views.translation(i) = of(tables_.translation[static_cast<std::size_t>(i)].data());
    views.image.width = of(tables_.width.data());
    views.image.height = of(tables_.height.data());
    views.image.begin =
        Ints([&](auto k) { return tables_.image_begin[static_cast<std::size_t>(view[k])]; });
  }

  // inconsistency() of geometric_check.h, times its weight.
  T inconsistency(const LanePixel& pixel, const refractive::AxialRay<T>& ray, const T& depth,
                  const Lookup<Abi>& of_view, const Views& views, const Vector& point,
                  const Image& image) const {
    const T limit(tables_.geometric_limit);
    // The ray of image.projection.pixel, because that is exact.
    const Vector along = point - image.origin();
    const T expected = sqrt(along.dot(along));
    const T found = lane_depth_near(tables_.depths.data(), views.image, image.projection, expected);
    const Vector shift = views.rotation.transpose() * (along * (found / expected - T(1)));
    const T term =
        inconsistency_term(shift_in_pixels(ray, ray_jacobian(pixel), depth, shift), limit);
    const T has = of_view(tables_.has_depth.data());
    return T(tables_.geometric_weight) * has * select(found > T(0), term, limit);
  }

  const SceneTables& tables_;
  Camera<T> reference_;
  Projector first_projector_;
};

template <class Abi>
std::unique_ptr<Scorer> make_lane_scorer(const SceneTables& tables) {
  switch (tables.kind) {
    case CameraKind::pinhole:
      return std::make_unique<LaneScorer<refractive::PinholeCamera, Abi>>(tables);
    case CameraKind::flat_port:
      return std::make_unique<LaneScorer<refractive::FlatPortCamera, Abi>>(tables);
    case CameraKind::dome_port:
      return std::make_unique<LaneScorer<refractive::DomePortCamera, Abi>>(tables);
  }
  return nullptr;
}

}  // namespace axial::depth::lanes
