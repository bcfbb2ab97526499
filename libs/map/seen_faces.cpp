// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/seen_faces.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "geometry/convex_part.h"
#include "geometry/faces.h"

namespace axial::map {
namespace {

using Corners = std::array<Eigen::Vector3d, 3>;
using HalfSpace = SeenFaces::HalfSpace;
using Points = std::vector<Eigen::Vector3d>;

constexpr double kInside = 1e-9;      // [m]: faces with a common edge do not hide each other
constexpr double kSameHeight = 1e-7;  // [m]: vertices are floats
constexpr int kBinSide = 8;           // [px] of the grid of the bins

// The grid of the bins: about eight faces for each bin of a square mesh.
MapGrid grid_of(const Mesh& mesh) {
  constexpr double kFaces = 8, kLeast = 16, kMost = 1024;
  const double bins =
      std::clamp(std::sqrt(static_cast<double>(mesh.faces.size()) / kFaces), kLeast, kMost);
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex : mesh.vertices) box.extend(vertex);
  const auto extent = static_cast<double>(box.sizes().head<2>().maxCoeff());
  return grid_around(mesh, {}, extent > 0 ? extent / (kBinSide * bins) : 1);
}

Eigen::AlignedBox2d box_of(const Corners& corners) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector3d& corner : corners) box.extend(corner.head<2>());
  return box;
}

// The half spaces of the edges and of the plane of a face; nothing if it is vertical. `above`: how
// far places must lie below the face [m].
std::optional<SeenFaces::Hidden> below(Corners corners, double above) {
  constexpr double kVertical = 1e-6;
  Eigen::Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  if (!(std::abs(normal.z()) > kVertical * normal.norm())) return std::nullopt;
  if (normal.z() < 0) {
    std::swap(corners[1], corners[2]);
    normal = -normal;
  }
  SeenFaces::Hidden hidden;
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3d along = corners[(k + 1) % 3] - corners[k];
    const double length = along.head<2>().norm();
    hidden[k] = {Eigen::Vector3d(-along.y(), along.x(), 0) / length, corners[k], kInside};
  }
  hidden[3] = {-normal / normal.z(), corners[0], above};
  return hidden;
}

bool is_outside(const HalfSpace& half, std::span<const Eigen::Vector3d> corners) {
  return std::ranges::none_of(corners, [&](const Eigen::Vector3d& x) { return half(x) > 0; });
}

// Adds the parts of `piece` that are not in all half spaces.
void cut(const Points& piece, const SeenFaces::Hidden& hidden, std::vector<Points>& parts) {
  constexpr std::size_t kLeast = 3;
  for (const HalfSpace& half : hidden)
    if (is_outside(half, piece)) return parts.push_back(piece);
  Points rest = piece, part;
  for (const HalfSpace& half : hidden) {
    geometry::convex_part(rest, half, part);
    std::swap(rest, part);
    if (rest.size() < kLeast) return parts.push_back(piece);
  }
  rest = piece;
  for (const HalfSpace& half : hidden) {
    geometry::convex_part(
        rest, [&](const Eigen::Vector3d& x) { return -half(x); }, part);
    if (part.size() >= kLeast) parts.push_back(part);
    geometry::convex_part(rest, half, part);
    std::swap(rest, part);
  }
}

}  // namespace

SeenFaces::SeenFaces(const Mesh& mesh)
    : mesh_(mesh), grid_(grid_of(mesh)), bins_(mesh, {}, grid_, kBinSide) {}

std::uint64_t SeenFaces::bytes(const Mesh& mesh) {
  return FaceBins::bytes(mesh, {}, grid_of(mesh), kBinSide);
}

std::vector<std::uint32_t> SeenFaces::faces_in(const Eigen::AlignedBox2d& box) const {
  std::vector<std::uint32_t> faces;
  const double width = kBinSide * grid_.pixel;
  const int columns = (grid_.columns + kBinSide - 1) / kBinSide,
            rows = (grid_.rows + kBinSide - 1) / kBinSide;
  const auto bin = [&](double length, int count) {
    return static_cast<int>(std::clamp(std::floor(length / width), 0.0, count - 1.0));
  };
  const int right = bin(box.max().x() - grid_.left, columns),
            low = bin(grid_.top - box.min().y(), rows);
  for (int row = bin(grid_.top - box.max().y(), rows); row <= low; ++row)
    for (int column = bin(box.min().x() - grid_.left, columns); column <= right; ++column) {
      const auto in_bin =
          bins_.faces(static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                      static_cast<std::size_t>(column));
      faces.insert(faces.end(), in_bin.begin(), in_bin.end());
    }
  std::ranges::sort(faces);
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return faces;
}

void SeenFaces::find_hidden(std::uint32_t face, const Eigen::AlignedBox2d& box,
                            std::vector<Hidden>& hidden) const {
  hidden.clear();
  const Corners corners = geometry::corners_of(mesh_, face);
  const Eigen::AlignedBox2d of_face = box_of(corners);
  const auto own = below(corners, 0);
  for (const std::uint32_t other : faces_in(of_face.intersection(box))) {
    if (other == face) continue;
    const Corners of_other = geometry::corners_of(mesh_, other);
    if (!of_face.intersects(box_of(of_other))) continue;
    const auto found = below(of_other, other < face ? -kSameHeight : kSameHeight);
    if (!found) continue;
    const auto separates = [](std::span<const Eigen::Vector3d> of) {
      return [of](const HalfSpace& half) { return is_outside(half, of); };
    };
    if (std::ranges::any_of(*found, separates(corners))) continue;
    if (own && std::any_of(own->begin(), own->begin() + 3, separates(of_other))) continue;
    hidden.push_back(*found);
  }
}

void for_seen_parts(std::span<const Eigen::Vector3d> piece,
                    std::span<const SeenFaces::Hidden> hidden,
                    const std::function<void(std::span<const Eigen::Vector3d>)>& use) {
  if (hidden.empty()) return use(piece);
  std::vector<Points> parts{{piece.begin(), piece.end()}}, next;
  for (const SeenFaces::Hidden& one : hidden) {
    next.clear();
    for (const Points& part : parts) cut(part, one, next);
    std::swap(parts, next);
  }
  for (const Points& part : parts) use(part);
}

}  // namespace axial::map
