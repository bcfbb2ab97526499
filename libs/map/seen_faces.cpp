// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/seen_faces.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>
#include <utility>

#include "base/order_statistics.h"
#include "geometry/convex_part.h"
#include "geometry/faces.h"
#include "map/frame.h"

namespace axial::map {
namespace {

using Corners = std::array<Eigen::Vector3d, 3>;
using HalfSpace = SeenFaces::HalfSpace;
using Points = std::vector<Eigen::Vector3d>;

constexpr double kInside = 1e-9;      // [m]: faces with a common edge do not hide each other
constexpr double kSameHeight = 1e-7;  // [m]: vertices are floats
constexpr int kBinSide = 8;           // [px] of the grid of the bins

// The box of the mesh without the outermost faces: a face far away would make the bins large. Faces
// outside of the grid are in the bins at its border.
Eigen::AlignedBox2d box_of_most(const Mesh& mesh) {
  constexpr std::size_t kSample = 1 << 16;
  constexpr double kLow = 0.01, kHigh = 0.99;
  const std::size_t step = mesh.faces.size() / kSample + 1;
  std::array<std::vector<double>, 2> values;
  for (std::size_t f = 0; f < mesh.faces.size(); f += step)
    for (std::size_t axis = 0; axis < 2; ++axis)
      values[axis].push_back(mesh.vertices[mesh.faces[f][0]][static_cast<int>(axis)]);
  Eigen::AlignedBox2d box(Eigen::Vector2d::Zero());
  for (std::size_t axis = 0; axis < 2 && !values[0].empty(); ++axis) {
    std::ranges::sort(values[axis]);
    box.min()[static_cast<int>(axis)] = interpolated_quantile<double>(values[axis], kLow);
    box.max()[static_cast<int>(axis)] = interpolated_quantile<double>(values[axis], kHigh);
  }
  return box;
}

// The grid of the bins: about eight faces for each bin.
MapGrid grid_of(const Mesh& mesh) {
  constexpr double kFaces = 8, kMostAlong = 4096;
  const Eigen::AlignedBox2d box = box_of_most(mesh);
  const double bins = static_cast<double>(mesh.faces.size()) / kFaces + 1;
  const double width =
      std::max(std::sqrt(box.sizes().prod() / bins), box.sizes().maxCoeff() / kMostAlong);
  return grid_over(box, width > 0 ? width / kBinSide : 1);
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

// Adds the parts of `piece` that are not in all half spaces. Faces with a common edge leave a line
// of 2e-9 m between what they hide. Without such lines, the number of parts stays small.
void cut(Points&& piece, const SeenFaces::Hidden& hidden, std::vector<Points>& parts) {
  constexpr std::size_t kLeast = 3;
  for (const HalfSpace& half : hidden)
    if (is_outside(half, piece)) return parts.push_back(std::move(piece));
  Points rest = piece, part;
  for (const HalfSpace& half : hidden) {
    geometry::convex_part(rest, half, part);
    std::swap(rest, part);
    if (rest.size() < kLeast) return parts.push_back(std::move(piece));
  }
  rest = std::move(piece);
  for (const HalfSpace& half : hidden) {
    geometry::convex_part(
        rest, [&](const Eigen::Vector3d& x) { return -half(x); }, part);
    if (part.size() >= kLeast && !is_narrow(part)) parts.push_back(part);
    geometry::convex_part(rest, half, part);
    std::swap(rest, part);
  }
}

}  // namespace

bool is_narrow(std::span<const Eigen::Vector3d> piece, const Eigen::Vector3d& along) {
  constexpr double kWidth = 1e-7;  // [m]
  double twice = 0, length = 0;
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& corner : piece) {
    const Eigen::Vector3d from_first = along.cwiseProduct(corner - piece[0]);
    twice += before.cross(from_first).norm();
    length = std::max(length, from_first.norm());
    before = from_first;
  }
  return twice <= kWidth * length;
}

SeenFaces::SeenFaces(const Mesh& mesh)
    : mesh_(mesh), grid_(grid_of(mesh)), bins_(mesh, {}, grid_, kBinSide) {}

std::uint64_t SeenFaces::bytes(const Mesh& mesh) {
  return FaceBins::bytes(mesh, {}, grid_of(mesh), kBinSide);
}

template <class Takes>
std::vector<std::uint32_t> SeenFaces::faces_in_bins(const Eigen::AlignedBox2d& box,
                                                    const Takes& takes) const {
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
      std::ranges::copy_if(in_bin, std::back_inserter(faces), takes);
    }
  std::ranges::sort(faces);
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return faces;
}

std::vector<std::uint32_t> SeenFaces::faces_in(const Eigen::AlignedBox2d& box) const {
  return faces_in_bins(box, [](std::uint32_t) { return true; });
}

void SeenFaces::find_hidden(std::uint32_t face, const Eigen::AlignedBox2d& box,
                            std::vector<Hidden>& hidden) const {
  hidden.clear();
  const Corners corners = geometry::corners_of(mesh_, face);
  const Eigen::AlignedBox2d of_face = box_of(corners);
  const auto own = below(corners, 0);
  const auto is_near = [&](std::uint32_t other) {
    return other != face && of_face.intersects(box_of(geometry::corners_of(mesh_, other)));
  };
  for (const std::uint32_t other : faces_in_bins(of_face.intersection(box), is_near)) {
    const Corners of_other = geometry::corners_of(mesh_, other);
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

namespace {

// Vertical half spaces on both sides of the middle of the longer side of a piece.
std::array<HalfSpace, 2> halves_of(std::span<const Eigen::Vector3d> piece) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& corner : piece) box.extend(corner);
  const Eigen::Vector3d normal =
      box.sizes().x() > box.sizes().y() ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  return {HalfSpace{normal, box.center()}, HalfSpace{-normal, box.center()}};
}

using Use = std::function<void(std::span<const Eigen::Vector3d>)>;

// What faces hide of a piece: all of them, and the indices of those that matter.
struct Hiding {
  std::span<const SeenFaces::Hidden> all;
  std::vector<std::uint32_t> found;

  Hiding of_part(std::span<const Eigen::Vector3d> piece) const {
    Hiding part{all, {}};
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector3d& corner : piece) box.extend(corner.head<2>());
    std::ranges::copy_if(found, std::back_inserter(part.found), [&](std::uint32_t face) {
      const SeenFaces::Hidden& one = all[face];
      // Not every face beside a slanting piece has an edge between them.
      return box.intersects(box_of({one[0].base, one[1].base, one[2].base})) &&
             std::ranges::none_of(one,
                                  [&](const HalfSpace& half) { return is_outside(half, piece); });
    });
    return part;
  }
};

void use_seen_parts(std::span<const Eigen::Vector3d> piece, const Hiding& hiding, const Use& use);

// Below many small faces, the time grows with the square of their number, so a large piece is cut
// into halves first. Returns false if this does not help. The larger half of a triangle has three
// quarters of its area.
bool use_halves(std::span<const Eigen::Vector3d> piece, const Hiding& hiding, const Use& use) {
  std::array<Points, 2> parts;
  std::array<Hiding, 2> of_parts;
  const std::array<HalfSpace, 2> halves = halves_of(piece);
  for (std::size_t k = 0; k < 2; ++k) {
    geometry::convex_part(piece, halves[k], parts[k]);
    of_parts[k] = hiding.of_part(parts[k]);
    if (10 * of_parts[k].found.size() > 9 * hiding.found.size()) return false;
  }
  for (std::size_t k = 0; k < 2; ++k)
    if (parts[k].size() > 2) use_seen_parts(parts[k], of_parts[k], use);
  return true;
}

void use_seen_parts(std::span<const Eigen::Vector3d> piece, const Hiding& hiding, const Use& use) {
  constexpr std::size_t kMany = 24;
  if (hiding.found.empty()) return use(piece);
  if (hiding.found.size() > kMany && use_halves(piece, hiding, use)) return;
  std::vector<Points> parts{{piece.begin(), piece.end()}}, next;
  for (const std::uint32_t face : hiding.found) {
    next.clear();
    for (Points& part : parts) cut(std::move(part), hiding.all[face], next);
    std::swap(parts, next);
  }
  for (const Points& part : parts) use(part);
}

}  // namespace

void for_seen_parts(std::span<const Eigen::Vector3d> piece,
                    std::span<const SeenFaces::Hidden> hidden, const Use& use) {
  Hiding all{hidden, std::vector<std::uint32_t>(hidden.size())};
  std::iota(all.found.begin(), all.found.end(), 0u);
  use_seen_parts(piece, all, use);
}

}  // namespace axial::map
