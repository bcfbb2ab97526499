// SPDX-License-Identifier: GPL-3.0-or-later
#include "boundary/cut_faces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "base/error.h"
#include "base/parallel.h"
#include "base/plane_cross.h"
#include "boundary/sides.h"

namespace axial::boundary {
namespace {

// A vertex, as a corner of the pieces of one face.
struct Corner {
  std::uint32_t vertex;
  Eigen::Vector3d at;
  Eigen::Vector2d plan;
  Eigen::Vector3d weights;  // of the corners of the face
};

using Three = std::array<std::size_t, 3>;  // indices of corners

// The pieces of one face while it is split.
struct Pieces {
  std::vector<Corner> corners;
  std::vector<Three> faces;
};

// The place of a vertex that is made on an edge: between its ends, as a share from the end with the
// lower number.
struct OnEdge {
  Eigen::Vector2d plan;
  double share;
};

// Where a side crosses the edge between two corners, of which `a` has the lower number. Empty if
// the side does not cross, or if it touches an end.
std::optional<OnEdge> crossing(const Corner& a, const Corner& b, const Side& side) {
  const Eigen::Vector2d along = side.to - side.from;
  const double length = along.norm();
  if (!(length > 0)) return {};
  const double left_a = plane_cross(along, a.plan - side.from) / length;
  const double left_b = plane_cross(along, b.plan - side.from) / length;
  if (std::min(left_a, left_b) > -kSame || std::max(left_a, left_b) < kSame) return {};
  const double share = left_a / (left_a - left_b);
  const Eigen::Vector2d place = a.plan + share * (b.plan - a.plan);
  const double at = along.dot(place - side.from) / length;
  if (at < -kSame || at > length + kSame) return {};
  return OnEdge{place, share};
}

// Whether the place lies on the edge between two corners, and not at an end of it.
std::optional<OnEdge> touch(const Corner& a, const Corner& b, const Eigen::Vector2d& place) {
  const Eigen::Vector2d edge = b.plan - a.plan, from_a = place - a.plan;
  const double length = edge.norm();
  if (!(length > 2 * kSame) || std::abs(plane_cross(edge, from_a)) > kSame * length) return {};
  const double at = edge.dot(from_a) / length;
  if (at <= kSame || at >= length - kSame) return {};
  return OnEdge{place, at / length};
}

class FaceCutter {
 public:
  FaceCutter(const Mesh& mesh, const Boundary& boundary, const Sides& sides)
      : mesh_(mesh), boundary_(boundary), sides_(sides) {}

  // Adds the pieces of a face, if it is split.
  void cut(std::size_t face, CutFaces& result) {
    Pieces pieces = begin(face);
    const std::vector<std::uint32_t> near = sides_.near(box_of(pieces));
    constexpr std::size_t kMost = 10'000;
    if (near.size() > kMost)
      fail_in(boundary_.name(), "has {} sides above one face of the mesh: simplify it",
              near.size());
    for (const std::uint32_t side : near) split_at_corner(pieces, side, result);
    for (const std::uint32_t side : near) split_along(pieces, side, result);
    if (pieces.faces.size() == 1) {
      result.outside[face] = !boundary_.contains(middle_of(pieces, pieces.faces[0]));
      return;
    }
    result.split_at[face] = static_cast<std::uint32_t>(result.splits.size());
    std::vector<Piece>& parts = result.splits.emplace_back();
    for (const Three& corners : pieces.faces) parts.push_back(part_of(pieces, corners));
  }

 private:
  Pieces begin(std::size_t face) {
    face_ = face;
    Pieces pieces;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = mesh_.faces[face][k];
      const Eigen::Vector3d at = mesh_.vertices[vertex].cast<double>();
      pieces.corners.push_back(
          {vertex, at, boundary_.plan_of(at), Eigen::Vector3d::Unit(static_cast<Eigen::Index>(k))});
    }
    pieces.faces.push_back({0, 1, 2});
    return pieces;
  }

  static Eigen::AlignedBox2d box_of(const Pieces& pieces) {
    Eigen::AlignedBox2d box;
    for (const Corner& corner : pieces.corners) box.extend(corner.plan);
    return box;
  }

  static Eigen::Vector2d middle_of(const Pieces& pieces, const Three& corners) {
    return (pieces.corners[corners[0]].plan + pieces.corners[corners[1]].plan +
            pieces.corners[corners[2]].plan) /
           3;
  }

  Piece part_of(const Pieces& pieces, const Three& corners) const {
    Piece piece;
    for (std::size_t k = 0; k < 3; ++k) {
      const Corner& corner = pieces.corners[corners[k]];
      piece.corners[k] = corner.vertex;
      piece.weights.col(static_cast<Eigen::Index>(k)) = corner.weights.cast<float>();
    }
    piece.outside = !boundary_.contains(middle_of(pieces, corners));
    return piece;
  }

  // Splits the pieces at the place where the side begins, if it is above or below them.
  void split_at_corner(Pieces& pieces, std::uint32_t side, CutFaces& result) {
    const Eigen::Vector2d place = sides_[side].from;
    const auto key = static_cast<std::uint32_t>(sides_.size() + side);
    const bool was_on_edge = split_edges(
        pieces, key, [&](const Corner& a, const Corner& b) { return touch(a, b, place); }, result);
    const auto is_there = [&](const Corner& corner) {
      return (corner.plan - place).norm() <= kSame;
    };
    if (!was_on_edge && std::ranges::none_of(pieces.corners, is_there))
      split_inside(pieces, place, result);
  }

  void split_along(Pieces& pieces, std::uint32_t side, CutFaces& result) {
    split_edges(
        pieces, side,
        [&](const Corner& a, const Corner& b) { return crossing(a, b, sides_[side]); }, result);
  }

  // Splits each edge of the pieces on which place_on(a, b) finds a place. `key`: of the places.
  // Returns whether there was one. A new edge ends at such a place, so that it has none.
  template <class PlaceOn>
  bool split_edges(Pieces& pieces, std::uint32_t key, const PlaceOn& place_on, CutFaces& result) {
    bool any = false;
    for (std::size_t f = 0; f < pieces.faces.size(); ++f)
      for (std::size_t k = 0; k < 3; ++k) {
        std::size_t i = pieces.faces[f][k], j = pieces.faces[f][(k + 1) % 3];
        if (pieces.corners[i].vertex > pieces.corners[j].vertex) std::swap(i, j);
        const auto place = place_on(pieces.corners[i], pieces.corners[j]);
        if (!place) continue;
        split_edge(pieces, i, j, add_on_edge(pieces, i, j, key, *place, result));
        any = true;
      }
    return any;
  }

  static void split_edge(Pieces& pieces, std::size_t i, std::size_t j, std::size_t middle) {
    for (std::size_t f = 0, count = pieces.faces.size(); f < count; ++f) {
      Three& face = pieces.faces[f];
      if (std::ranges::count(face, i) == 0 || std::ranges::count(face, j) == 0) continue;
      Three other = face;
      std::ranges::replace(face, j, middle);
      std::ranges::replace(other, i, middle);
      pieces.faces.push_back(other);
    }
  }

  // The index of the new corner on the edge from corner `i` to corner `j`.
  std::size_t add_on_edge(Pieces& pieces, std::size_t i, std::size_t j, std::uint32_t key,
                          const OnEdge& place, CutFaces& result) {
    const Corner &a = pieces.corners[i], &b = pieces.corners[j];
    const auto between = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
      return Eigen::Vector3d(from + place.share * (to - from));
    };
    Corner corner{0, between(a.at, b.at), place.plan, between(a.weights, b.weights)};
    const auto [made, is_new] = made_.emplace(std::array{a.vertex, b.vertex, key}, 0);
    if (is_new) made->second = add_vertex(corner, result);
    corner.vertex = made->second;
    pieces.corners.push_back(corner);
    return pieces.corners.size() - 1;
  }

  void split_inside(Pieces& pieces, const Eigen::Vector2d& place, CutFaces& result) {
    for (std::size_t f = 0; f < pieces.faces.size(); ++f) {
      const Three face = pieces.faces[f];
      const auto plan = [&](std::size_t k) { return pieces.corners[face[k]].plan; };
      const Eigen::Vector3d parts(plane_cross(plan(1) - place, plan(2) - place),
                                  plane_cross(plan(2) - place, plan(0) - place),
                                  plane_cross(plan(0) - place, plan(1) - place));
      if (!(parts.minCoeff() > 0) && !(parts.maxCoeff() < 0)) continue;
      const Eigen::Vector3d shares = parts / parts.sum();
      Corner corner{0, Eigen::Vector3d::Zero(), place, Eigen::Vector3d::Zero()};
      for (std::size_t k = 0; k < 3; ++k) {
        const double share = shares[static_cast<Eigen::Index>(k)];
        corner.at += share * pieces.corners[face[k]].at;
        corner.weights += share * pieces.corners[face[k]].weights;
      }
      corner.vertex = add_vertex(corner, result);
      pieces.corners.push_back(corner);
      const std::size_t middle = pieces.corners.size() - 1;
      pieces.faces[f] = {face[0], face[1], middle};
      pieces.faces.push_back({face[1], face[2], middle});
      pieces.faces.push_back({face[2], face[0], middle});
      return;
    }
  }

  std::uint32_t add_vertex(const Corner& corner, CutFaces& result) const {
    const auto index = static_cast<std::uint32_t>(mesh_.vertices.size() + result.vertices.size());
    result.vertices.emplace_back(corner.at.cast<float>());
    if (mesh_.colors.empty()) return index;
    Rgb color{};
    for (std::size_t c = 0; c < 3; ++c) {
      double sum = 0.5;
      for (std::size_t k = 0; k < 3; ++k)
        sum +=
            corner.weights[static_cast<Eigen::Index>(k)] * mesh_.colors[mesh_.faces[face_][k]][c];
      color[c] = static_cast<std::uint8_t>(std::clamp(sum, 0.0, 255.0));
    }
    result.colors.push_back(color);
    return index;
  }

  const Mesh& mesh_;
  const Boundary& boundary_;
  const Sides& sides_;
  std::size_t face_ = 0;
  // The vertices on edges: by the vertices at the ends, the lower number first, and by the place.
  std::map<std::array<std::uint32_t, 3>, std::uint32_t> made_;
};

}  // namespace

CutFaces cut_faces(const Mesh& mesh, const Boundary& boundary) {
  const Sides sides(boundary);
  CutFaces result;
  result.outside.resize(mesh.faces.size());
  result.split_at.assign(mesh.faces.size(), CutFaces::kWhole);
  std::vector<std::uint8_t> may_cross(mesh.faces.size());
  parallel_for(
      mesh.faces.size(),
      [&](std::size_t f) {
        Eigen::AlignedBox2d box;
        Eigen::Vector2d middle = Eigen::Vector2d::Zero();
        for (const std::uint32_t vertex : mesh.faces[f]) {
          const Eigen::Vector2d plan = boundary.plan_of(mesh.vertices[vertex].cast<double>());
          box.extend(plan);
          middle += plan / 3;
        }
        may_cross[f] = sides.any_near(box);
        if (!may_cross[f]) result.outside[f] = !boundary.contains(middle);
      },
      kPointGrain);
  FaceCutter cutter(mesh, boundary, sides);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    if (may_cross[f]) cutter.cut(f, result);
  return result;
}

std::uint64_t bytes_to_cut(const Mesh& mesh) {
  return mesh.faces.size() * (2 + sizeof(std::uint32_t));
}

}  // namespace axial::boundary
