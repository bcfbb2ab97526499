// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/topology.h"

#include <algorithm>
#include <span>
#include <vector>

#include "base/disjoint_sets.h"
#include "evaluate/self_intersections.h"
#include "scene/check_mesh.h"

namespace axial::evaluate {
namespace {

// The side of a face from one corner to the next, of the vertices low < high.
struct Side {
  std::uint32_t low, high, face;
  std::uint8_t at_low, at_high;  // corners of the face
  bool upwards;                  // the face passes the edge from low to high

  // clang-tidy takes a literal of the comparison that the compiler makes for a null pointer.
  auto operator<=>(const Side&) const = default;  // NOLINT(modernize-use-nullptr)
};

std::vector<Side> sides_of(const Mesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(3 * mesh.faces.size());
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
    for (std::uint8_t k = 0; k < 3; ++k) {
      const auto next = static_cast<std::uint8_t>((k + 1) % 3);
      const std::uint32_t from = mesh.faces[f][k], to = mesh.faces[f][next];
      sides.push_back(from < to ? Side{from, to, f, k, next, true}
                                : Side{to, from, f, next, k, false});
    }
  std::ranges::sort(sides);
  return sides;
}

// Calls visit(sides of one edge) for every edge.
template <class Visit>
void for_each_edge(std::span<const Side> sides, const Visit& visit) {
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].low == sides[begin].low &&
           sides[end].high == sides[begin].high)
      ++end;
    visit(sides.subspan(begin, end - begin));
  }
}

void count_edges(std::span<const Side> sides, std::size_t vertices, Topology& topology) {
  DisjointSets<std::size_t> border(vertices);
  std::size_t border_vertices = 0, joined = 0;
  std::vector<bool> on_border(vertices, false);
  const auto mark = [&](std::uint32_t vertex) {
    if (!on_border[vertex]) ++border_vertices;
    on_border[vertex] = true;
  };
  for_each_edge(sides, [&](std::span<const Side> edge) {
    ++topology.edges;
    if (edge.size() > 2) ++topology.non_manifold_edges;
    if (edge.size() == 2 && edge[0].upwards == edge[1].upwards) ++topology.inconsistent_edges;
    if (edge.size() > 1) return;
    ++topology.border_edges;
    mark(edge[0].low);
    mark(edge[0].high);
    if (border.join(edge[0].low, edge[0].high)) ++joined;
  });
  topology.border_loops = border_vertices - joined;
}

std::size_t count_components(std::span<const Side> sides, std::size_t faces) {
  DisjointSets<std::size_t> groups(faces);
  std::size_t components = faces;
  for_each_edge(sides, [&](std::span<const Side> edge) {
    for (const Side& side : edge)
      if (groups.join(edge[0].face, side.face)) --components;
  });
  return components;
}

// Joins the corners of the faces at each vertex over the edges of two faces: each group of corners
// is a fan.
void count_vertices(const Mesh& mesh, std::span<const Side> sides, Topology& topology) {
  DisjointSets<std::size_t> corners(3 * mesh.faces.size());
  std::vector<std::uint8_t> fans(mesh.vertices.size(), 0);  // 2: more than one
  const auto corner = [](std::uint32_t face, std::uint8_t at) {
    return std::size_t{3} * face + at;
  };
  for_each_edge(sides, [&](std::span<const Side> edge) {
    if (edge.size() > 2) fans[edge[0].low] = fans[edge[0].high] = 2;
    if (edge.size() != 2) return;
    corners.join(corner(edge[0].face, edge[0].at_low), corner(edge[1].face, edge[1].at_low));
    corners.join(corner(edge[0].face, edge[0].at_high), corner(edge[1].face, edge[1].at_high));
  });
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
    for (std::uint8_t k = 0; k < 3; ++k)
      if (corners.root(corner(f, k)) == corner(f, k)) {
        std::uint8_t& count = fans[mesh.faces[f][k]];
        count = static_cast<std::uint8_t>(std::min(count + 1, 2));
      }
  for (const std::uint8_t count : fans) {
    if (count > 0) ++topology.vertices;
    if (count > 1) ++topology.non_manifold_vertices;
  }
}

}  // namespace

Topology topology_of(const Mesh& mesh) {
  if (!mesh.faces.empty()) check_mesh(mesh);
  Mesh whole;  // without degenerate faces
  whole.vertices = mesh.vertices;
  std::ranges::copy_if(mesh.faces, std::back_inserter(whole.faces),
                       [&](const auto& face) { return !is_degenerate(mesh, face); });
  Topology topology;
  topology.faces = whole.faces.size();
  topology.degenerate_faces = mesh.faces.size() - whole.faces.size();
  const std::vector<Side> sides = sides_of(whole);
  count_edges(sides, whole.vertices.size(), topology);
  topology.components = count_components(sides, whole.faces.size());
  count_vertices(whole, sides, topology);
  topology.self_intersecting_faces = self_intersecting_faces(whole).size();
  return topology;
}

}  // namespace axial::evaluate
