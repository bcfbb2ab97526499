// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/area_measures.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/parallel.h"
#include "geometry/convex_part.h"
#include "geometry/faces.h"

namespace axial::map {

// Sums over the surface, seen from above: of 1, of (x, y, height), and of their products.
struct AreaMoments {
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

namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

HeightPlane fitted(const AreaMoments& moments) {
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
double volume_beside(const HeightPlane& plane, Corners piece, double side, Points& part) {
  const auto distance = [&](const Eigen::Vector3d& x) { return side * plane.height_of(x); };
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

constexpr int kBinSide = 8,
              kBins = 128;  // [px] of the grid of FaceBins; bins along the longer side

// The grid of the bins of faces.
MapGrid grid_of(const Mesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex : mesh.vertices) box.extend(vertex);
  const auto extent = static_cast<double>(box.sizes().head<2>().maxCoeff());
  return grid_around(mesh, {}, extent > 0 ? extent / (kBinSide * kBins) : 1);
}

}  // namespace

// What the pieces of the faces above a part add up to.
struct AreaSums {
  AreaMoments moments;
  double up = 0, down = 0;  // projected areas of faces that are turned up and down
  double surface = 0, above = 0, below = 0;
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;

  // `memory`: for the parts of the piece.
  void add(Corners piece, const HeightPlane& rim, Points& memory) {
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
      (twice.z() > 0 ? up : down) += std::abs(twice.z()) / 2;
      moments.add(twice.z() / 2, corners);
    }
    above += volume_beside(rim, piece, 1, memory);
    below += volume_beside(rim, piece, -1, memory);
  }

  void add(const AreaSums& other) {
    moments.area += other.moments.area;
    moments.first += other.moments.first;
    moments.second += other.moments.second;
    up += other.up;
    down += other.down;
    surface += other.surface;
    above += other.above;
    below += other.below;
    lowest = std::min(lowest, other.lowest);
    highest = std::max(highest, other.highest);
  }

  // Whether faces are above the polygon, and more of them turned up than down, by more than
  // rounding.
  bool has_surface() const { return up - down > 1e-6 * (up + down); }
};

double AreaMeasures::rugosity() const {
  return plane.is_known() ? surface / planar : kNotKnown;
}

double AreaMeasures::rugosity_on_slope() const {
  return rugosity() / std::sqrt(1 + plane.gradient.squaredNorm());
}

double AreaMeasures::roughness() const {
  return std::sqrt(plane.variance);
}

double AreaMeasures::slope_degrees() const {
  return plane.is_known() ? std::atan(plane.gradient.norm()) * kDegrees : kNotKnown;
}

double AreaMeasures::aspect_degrees() const {
  constexpr double kLevel = 1e-6;  // vertices are floats
  if (plane.gradient.norm() < kLevel) return kNotKnown;
  const double angle = std::atan2(-plane.gradient.x(), -plane.gradient.y()) * kDegrees;
  return angle < 0 ? angle + 360 : angle;
}

AreaMeter::AreaMeter(const Mesh& mesh, const Eigen::Vector3d& origin)
    : mesh_(mesh),
      origin_(origin),
      surface_(mesh),
      grid_(grid_of(mesh)),
      bins_(mesh, {}, grid_, kBinSide) {
  top_ = -std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    top_ = std::max(top_, static_cast<double>(vertex.z()));
  top_ += 1;
}

std::uint64_t AreaMeter::bytes(const Mesh& mesh) {
  return geometry::bytes_of_surface(mesh) + FaceBins::bytes(mesh, {}, grid_of(mesh), kBinSide);
}

AreaMeasures AreaMeter::measure(const Area& area) const {
  AreaMeasures found;
  AreaSums sums;
  double rims = 0;
  for (const auto& part : area.parts) rims += add_part(part, found, sums);
  found.rim = rims / static_cast<double>(area.parts.size());
  if (!sums.has_surface()) return found;
  found.planar = sums.moments.area;
  found.surface = sums.surface;
  found.plane = fitted(sums.moments);
  found.plane.middle += origin_.head<2>();
  found.plane.level += origin_.z();
  found.lowest = sums.lowest + origin_.z();
  found.highest = sums.highest + origin_.z();
  found.above = sums.above;
  found.below = sums.below;
  return found;
}

double AreaMeter::add_part(std::span<const geometry::Ring> rings, AreaMeasures& found,
                           AreaSums& sums) const {
  std::vector<geometry::Ring> local(rings.begin(), rings.end());
  Eigen::AlignedBox2d box;
  for (geometry::Ring& ring : local)
    for (Eigen::Vector2d& corner : ring) {
      corner -= origin_.head<2>();
      box.extend(corner);
    }
  const geometry::PolygonPieces pieces(local);
  found.polygon += pieces.area();
  double share = 0;
  const HeightPlane rim = rim_of(local, share);
  const std::vector<std::uint32_t> faces = faces_in(box);
  constexpr std::size_t kChunk = 1 << 15;
  std::vector<AreaSums> chunks((faces.size() + kChunk - 1) / kChunk);
  parallel_for(chunks.size(), [&](std::size_t chunk) {
    geometry::PolygonPieces::Scratch scratch;
    Points memory;
    const std::size_t end = std::min(faces.size(), (chunk + 1) * kChunk);
    for (std::size_t i = chunk * kChunk; i < end; ++i)
      pieces.clip(geometry::corners_of(mesh_, faces[i]), scratch,
                  [&](Corners piece) { chunks[chunk].add(piece, rim, memory); });
  });
  for (const AreaSums& chunk : chunks) sums.add(chunk);
  if (!rim.is_known()) sums.above = sums.below = kNotKnown;
  return share;
}

std::vector<std::uint32_t> AreaMeter::faces_in(const Eigen::AlignedBox2d& box) const {
  std::vector<std::uint32_t> faces;
  for (std::size_t bin = 0; bin < bins_.blocks(); ++bin) {
    const cv::Rect at = bins_.pixels(bin);
    const Eigen::AlignedBox2d of_bin(
        Eigen::Vector2d(grid_.left + at.x * grid_.pixel, grid_.top - at.br().y * grid_.pixel),
        Eigen::Vector2d(grid_.left + at.br().x * grid_.pixel, grid_.top - at.y * grid_.pixel));
    if (!box.intersects(of_bin)) continue;
    const auto in_bin = bins_.faces(bin);
    faces.insert(faces.end(), in_bin.begin(), in_bin.end());
  }
  std::ranges::sort(faces);
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return faces;
}

HeightPlane AreaMeter::rim_of(std::span<const geometry::Ring> rings, double& share) const {
  constexpr int kPlaces = 2000;
  constexpr double kLeastShare = 0.5;
  AreaMoments moments;
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
  if (share < kLeastShare) return {};
  return fitted(moments);
}

}  // namespace axial::map
