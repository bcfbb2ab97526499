// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/area_measures.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "geometry/convex_part.h"
#include "geometry/faces.h"

namespace axial::map {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

// Sums over the surface, seen from above: of 1, of (x, y, height), and of their products.
struct Moments {
  double area = 0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();

  // The second moment of a triangle of area A with the corners v_k and the mean g is
  // A / 12 (9 g g' + sum of v_k v_k').
  void add(double projected, const Eigen::Matrix3d& corners) {
    const Eigen::Vector3d mean = corners.rowwise().mean();
    area += projected;
    first += projected * mean;
    second += projected / 12 * (9 * mean * mean.transpose() + corners * corners.transpose());
  }

  void add_place(const Eigen::Vector3d& x) {
    area += 1;
    first += x;
    second += x * x.transpose();
  }
};

HeightPlane fitted(const Moments& moments) {
  const Eigen::Vector3d mean = moments.first / moments.area;
  const Eigen::Matrix3d central = moments.second / moments.area - mean * mean.transpose();
  const Eigen::Vector2d with_height = central.topRightCorner<2, 1>();
  const Eigen::Vector2d gradient =
      central.topLeftCorner<2, 2>().completeOrthogonalDecomposition().solve(with_height);
  return {mean.head<2>(), gradient, mean.z(),
          std::max(0.0, central(2, 2) - gradient.dot(with_height))};
}

using Corners = std::span<const Eigen::Vector3d>;
using Points = std::vector<Eigen::Vector3d>;

// The volume between a convex piece of a face and the plane where the piece is above (`side` 1) or
// below (-1) the plane. Negative for faces that are turned down.
double volume_beside(const HeightPlane& plane, Corners piece, double side) {
  const auto distance = [&](const Eigen::Vector3d& x) { return side * plane.height_of(x); };
  Points part;
  geometry::convex_part(piece, distance, part);
  double sum = 0;
  for (std::size_t k = 2; k < part.size(); ++k)
    sum += (part[k - 1] - part[0]).cross(part[k] - part[0]).z() *
           (distance(part[0]) + distance(part[k - 1]) + distance(part[k]));
  return sum / 6;
}

// Places along the rings, evenly.
std::vector<Eigen::Vector2d> places_on_rim(std::span<const geometry::Ring> rings, int count) {
  const auto next = [](const geometry::Ring& ring, std::size_t i) {
    return ring[(i + 1) % ring.size()];
  };
  double length = 0;
  for (const geometry::Ring& ring : rings)
    for (std::size_t i = 0; i < ring.size(); ++i) length += (next(ring, i) - ring[i]).norm();
  const double step = length / count;
  std::vector<Eigen::Vector2d> places;
  double at = step / 2;  // of the next place, from the corner on
  for (const geometry::Ring& ring : rings)
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Eigen::Vector2d along = next(ring, i) - ring[i];
      const double end = along.norm();
      for (; at < end; at += step) places.push_back(ring[i] + at / end * along);
      at -= end;
    }
  return places;
}

// What the pieces of the faces above a polygon add up to.
struct Sums {
  Moments moments;
  double surface = 0, above = 0, below = 0;
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;

  void add(Corners piece, const HeightPlane& rim) {
    for (const Eigen::Vector3d& corner : piece) {
      lowest = std::min(lowest, corner.z());
      highest = std::max(highest, corner.z());
    }
    for (std::size_t k = 2; k < piece.size(); ++k) {
      Eigen::Matrix3d corners;
      corners << piece[0], piece[k - 1], piece[k];
      const Eigen::Vector3d twice =
          (corners.col(1) - corners.col(0)).cross(corners.col(2) - corners.col(0));
      surface += twice.norm() / 2;
      moments.add(twice.z() / 2, corners);
    }
    above += volume_beside(rim, piece, 1);
    below += volume_beside(rim, piece, -1);
  }
};

}  // namespace

double AreaMeasures::rugosity_on_slope() const {
  return rugosity() / std::sqrt(1 + plane.gradient.squaredNorm());
}

double AreaMeasures::roughness() const {
  return std::sqrt(plane.variance);
}

double AreaMeasures::slope_degrees() const {
  return std::atan(plane.gradient.norm()) * kDegrees;
}

double AreaMeasures::aspect_degrees() const {
  const double angle = std::atan2(-plane.gradient.x(), -plane.gradient.y()) * kDegrees;
  return angle < 0 ? angle + 360 : angle;
}

AreaMeter::AreaMeter(const Mesh& mesh, const Eigen::Vector3d& origin)
    : mesh_(mesh), origin_(origin), surface_(mesh) {
  top_ = -std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    top_ = std::max(top_, static_cast<double>(vertex.z()));
  top_ += 1;
}

AreaMeasures AreaMeter::measure(const Area& area) const {
  std::vector<geometry::Ring> rings = area.rings;
  Eigen::AlignedBox2d box;
  for (geometry::Ring& ring : rings)
    for (Eigen::Vector2d& corner : ring) {
      corner -= origin_.head<2>();
      box.extend(corner);
    }
  const geometry::PolygonPieces pieces(rings);
  AreaMeasures found;
  found.polygon = pieces.area();
  const HeightPlane rim = rim_of(rings, found.rim);
  Sums sums;
  for (std::size_t f = 0; f < mesh_.faces.size(); ++f) {
    const auto corners = geometry::corners_of(mesh_, f);
    const Eigen::AlignedBox2d face(
        corners[0].head<2>().cwiseMin(corners[1].head<2>()).cwiseMin(corners[2].head<2>()),
        corners[0].head<2>().cwiseMax(corners[1].head<2>()).cwiseMax(corners[2].head<2>()));
    if (box.intersects(face)) pieces.clip(corners, [&](Corners piece) { sums.add(piece, rim); });
  }
  if (!(sums.moments.area > 0)) return found;
  const HeightPlane plane = fitted(sums.moments);
  found.planar = sums.moments.area;
  found.surface = sums.surface;
  found.plane = plane;
  found.plane.middle += origin_.head<2>();
  found.plane.level += origin_.z();
  found.lowest = sums.lowest + origin_.z();
  found.highest = sums.highest + origin_.z();
  const bool has_rim = std::isfinite(rim.level);
  found.above = has_rim ? sums.above : std::numeric_limits<double>::quiet_NaN();
  found.below = has_rim ? sums.below : std::numeric_limits<double>::quiet_NaN();
  return found;
}

HeightPlane AreaMeter::rim_of(std::span<const geometry::Ring> rings, double& share) const {
  constexpr int kPlaces = 2000;
  constexpr double kLeastShare = 0.5;
  Moments moments;
  int met = 0;
  const std::vector<Eigen::Vector2d> places = places_on_rim(rings, kPlaces);
  for (const Eigen::Vector2d& place : places)
    if (const auto hit =
            surface_.first_hit({place.x(), place.y(), top_}, -Eigen::Vector3d::UnitZ())) {
      const auto [a, b, c] = geometry::corners_of(mesh_, hit->face);
      const Eigen::Vector3d at = a + hit->u * (b - a) + hit->v * (c - a);
      moments.add_place({place.x(), place.y(), at.z()});
      ++met;
    }
  share = static_cast<double>(met) / static_cast<double>(places.size());
  if (share < kLeastShare)
    return {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero(),
            std::numeric_limits<double>::quiet_NaN()};
  return fitted(moments);
}

}  // namespace axial::map
