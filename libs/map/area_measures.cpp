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
#include "geometry/vertex_bends.h"

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
// below (-1) the plane.
double volume_beside(const HeightPlane& plane, Corners piece, double side, Points& part) {
  const auto distance = [&](const Eigen::Vector3d& x) { return side * plane.height_of(x); };
  geometry::convex_part(piece, distance, part);
  double sum = 0;
  for (std::size_t k = 2; k < part.size(); ++k)
    sum += std::abs((part[k - 1] - part[0]).cross(part[k] - part[0]).z()) *
           (distance(part[0]) + distance(part[k - 1]) + distance(part[k]));
  return sum / 6;
}

// What noise with the standard deviation `sigma` adds to the mean height above a plane, of the part
// above it, where the surface is at the height `height`: E max(0, h + n) - max(0, h).
double added_by_noise(double height, double sigma) {
  if (!(sigma > 0)) return 0;
  const double t = std::abs(height) / sigma;
  const double density = std::exp(-t * t / 2) / std::sqrt(2 * std::numbers::pi);
  return sigma * (density - t * std::erfc(t / std::numbers::sqrt2) / 2);
}

double length_of(const geometry::Ring& ring) {
  double length = 0;
  for (std::size_t i = 0; i < ring.size(); ++i)
    length += (ring[(i + 1) % ring.size()] - ring[i]).norm();
  return length;
}

// Places along the rings, evenly.
std::vector<Eigen::Vector2d> places_on_rim(std::span<const geometry::Ring> rings, int count) {
  const auto next = [](const geometry::Ring& ring, std::size_t i) {
    return ring[(i + 1) % ring.size()];
  };
  double length = 0;
  for (const geometry::Ring& ring : rings) length += length_of(ring);
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

}  // namespace

// What the pieces of the faces above a part add up to.
struct AreaSums {
  AreaMoments moments;
  double surface = 0, seen = 0, above = 0, below = 0;
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  double spacing = 0, variance = 0;  // sums over the seen surface, weighted by area
  double added = 0;                  // to `above` and to `below` by noise

  // Of the face of a piece: the distance of its vertices, and their variance along the normal.
  struct OfFace {
    double spacing, variance;
  };

  // `memory`: for the parts of the piece.
  void add_seen(Corners piece, const OfFace& face, const HeightPlane& rim, Points& memory) {
    // The measured height has the noise s already. At a place in the plane, the mean over this
    // noise of what a further noise t adds is in proportion to sqrt(s^2 + t^2) - s. It is what the
    // noise s adds to the true surface if t = sqrt(3) s.
    static const double kNoisyHeight = std::sqrt(3);
    if (!is_narrow(piece, {1, 1, 0}))
      for (const Eigen::Vector3d& corner : piece) {
        lowest = std::min(lowest, corner.z());
        highest = std::max(highest, corner.z());
      }
    for (std::size_t k = 2; k < piece.size(); ++k) {
      Eigen::Matrix3d corners;
      corners << piece[0], piece[k - 1], piece[k];
      const Eigen::Vector3d twice =
          (corners.col(1) - corners.col(0)).cross(corners.col(2) - corners.col(0));
      const double area = twice.norm() / 2, planar = std::abs(twice.z()) / 2;
      seen += area;
      spacing += area * face.spacing;
      variance += area * face.variance;
      if (!(planar > 0)) continue;
      moments.add(planar, corners);
      added += planar * added_by_noise(rim.height_of(corners.rowwise().mean()),
                                       kNoisyHeight * std::sqrt(face.variance) * area / planar);
    }
    above += volume_beside(rim, piece, 1, memory);
    below += volume_beside(rim, piece, -1, memory);
  }

  void add(const AreaSums& other) {
    moments.area += other.moments.area;
    moments.first += other.moments.first;
    moments.second += other.moments.second;
    surface += other.surface;
    seen += other.seen;
    above += other.above;
    below += other.below;
    spacing += other.spacing;
    variance += other.variance;
    added += other.added;
    lowest = std::min(lowest, other.lowest);
    highest = std::max(highest, other.highest);
  }
};

namespace {

double area_of_piece(Corners piece) {
  Eigen::Vector3d twice = Eigen::Vector3d::Zero();
  for (std::size_t k = 2; k < piece.size(); ++k)
    twice += (piece[k - 1] - piece[0]).cross(piece[k] - piece[0]);
  return twice.norm() / 2;
}

// The standard deviation of the volumes by independent noise of the vertices. `rim`: length of the
// polygon's rim [m].
double noise_of_volume(const AreaSums& sums, double rim) {
  // The plane through the rim is fitted to a line of vertices, and may be tilted.
  constexpr double kTilted = 2;
  const double spacing = sums.spacing / sums.seen, area = sums.moments.area;
  const double height = sums.variance / sums.seen * std::pow(sums.seen / area, 2);
  const double surface = height * spacing * spacing * area,
               plane = kTilted * height * area * area * spacing / rim;
  return std::sqrt(surface + plane + sums.added * sums.added);
}

}  // namespace

double AreaMeasures::rugosity() const {
  return plane.is_known() ? seen / planar : kNotKnown;
}

double AreaMeasures::whole_rugosity() const {
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
      faces_(mesh),
      bends_(geometry::vertex_bends(mesh)) {
  top_ = -std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    top_ = std::max(top_, static_cast<double>(vertex.z()));
  top_ += 1;
}

std::uint64_t AreaMeter::bytes(const Mesh& mesh) {
  constexpr std::uint64_t kOfVertex = sizeof(float) + sizeof(Eigen::Vector3f) +
                                      sizeof(Eigen::Vector3d) + sizeof(int);  // of vertex_bends()
  return geometry::bytes_of_surface(mesh) + SeenFaces::bytes(mesh) +
         kOfVertex * mesh.vertices.size();
}

double AreaMeter::variance_at(std::uint32_t face) const {
  constexpr double kNeighbours = 6;
  double sum = 0;
  for (const std::uint32_t vertex : mesh_.faces[face])
    sum += std::pow(static_cast<double>(bends_[vertex]), 2);
  return sum / 3 / (1 + 1 / kNeighbours);
}

AreaMeasures AreaMeter::measure(const Area& area) const {
  AreaMeasures found;
  AreaSums sums;
  double rims = 0;
  for (const auto& part : area.parts) rims += add_part(part, found, sums);
  found.rim = rims / static_cast<double>(area.parts.size());
  found.surface = sums.surface;
  if (!(sums.moments.area > 0)) return found;
  found.planar = sums.moments.area;
  found.seen = sums.seen;
  found.spacing = sums.spacing / sums.seen;
  found.noise = std::sqrt(sums.variance / sums.seen);
  found.plane = fitted(sums.moments);
  found.plane.middle += origin_.head<2>();
  found.plane.level += origin_.z();
  found.lowest = sums.lowest + origin_.z();
  found.highest = sums.highest + origin_.z();
  found.above = sums.above;
  found.below = sums.below;
  double rim = 0;
  for (const auto& part : area.parts)
    for (const geometry::Ring& ring : part) rim += length_of(ring);
  if (std::isfinite(sums.above)) found.volume_noise = noise_of_volume(sums, rim);
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
  const std::vector<std::uint32_t> faces = faces_.faces_in(box);
  constexpr std::size_t kChunk = 1 << 15;
  std::vector<AreaSums> chunks((faces.size() + kChunk - 1) / kChunk);
  parallel_for(chunks.size(), [&](std::size_t chunk) {
    geometry::PolygonPieces::Scratch scratch;
    Points memory;
    std::vector<SeenFaces::Hidden> hidden;
    AreaSums& of_chunk = chunks[chunk];
    const std::size_t end = std::min(faces.size(), (chunk + 1) * kChunk);
    for (std::size_t i = chunk * kChunk; i < end; ++i) {
      bool is_met = false;  // most faces of a thin polygon's box do not meet the polygon
      const AreaSums::OfFace face{std::sqrt(geometry::area_vector(mesh_, faces[i]).norm()),
                                  variance_at(faces[i])};
      pieces.clip(geometry::corners_of(mesh_, faces[i]), scratch, [&](Corners piece) {
        if (!std::exchange(is_met, true)) faces_.find_hidden(faces[i], box, hidden);
        of_chunk.surface += area_of_piece(piece);
        for_seen_parts(piece, hidden,
                       [&](Corners part) { of_chunk.add_seen(part, face, rim, memory); });
      });
    }
  });
  for (const AreaSums& chunk : chunks) sums.add(chunk);
  if (!rim.is_known()) sums.above = sums.below = kNotKnown;
  return share;
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
