// SPDX-License-Identifier: GPL-3.0-or-later
#include "labels/labelled_surface.h"

#include <algorithm>
#include <limits>

#include "geometry/faces.h"

namespace axial::labels {

LabelledSurface::LabelledSurface(const Mesh& mesh, const LocalFrame& frame,
                                 const map::WorldAxes& axes)
    : mesh_(mesh), surface_(mesh), axes_(axes.axes) {
  const Eigen::Vector3d at = axes.axes * frame.origin + axes.offset;
  origin_ = at.array().round();
  offset_ = at - origin_;
  top_ = -std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    top_ = std::max(top_, to_map(vertex.cast<double>()).z());
  top_ += 1;
}

std::optional<Eigen::Vector3d> LabelledSurface::first_on(const Eigen::Vector3d& from,
                                                         const Eigen::Vector3d& direction) const {
  const auto hit = surface_.first_hit(from, direction);
  if (!hit || (!mesh_.unseen.empty() && mesh_.unseen[hit->face] != 0)) return std::nullopt;
  const auto [a, b, c] = geometry::corners_of(mesh_, hit->face);
  const double u = hit->u, v = hit->v;
  return to_map((1 - u - v) * a + u * b + v * c);
}

std::optional<Eigen::Vector3d> LabelledSurface::seen_by(const Sight& sight) const {
  return first_on(sight.from, sight.direction);
}

std::optional<Eigen::Vector3d> LabelledSurface::highest(const Eigen::Vector2d& at) const {
  return first_on(from_map({at.x(), at.y(), top_}), -axes_.row(2).transpose());
}

std::optional<Eigen::Vector2d> LabelledSurface::pixel_of(const PosedRays& rays,
                                                         const Eigen::Vector3d& place) const {
  constexpr double kTolerance = 1e-3;
  const Eigen::Vector3d on_mesh = from_map(place);
  const auto pixel = rays.pixel_of(on_mesh);
  if (!pixel || !rays.is_in_photograph(*pixel)) return std::nullopt;
  const auto sight = rays.sight(*pixel);
  if (!sight || surface_.between(sight->from, on_mesh, 0, kTolerance)) return std::nullopt;
  return pixel;
}

std::uint64_t bytes_of_labelled_surface(const Mesh& mesh) {
  return geometry::bytes_of_surface(mesh);
}

}  // namespace axial::labels
