// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/topology.h"

#include <algorithm>
#include <span>
#include <vector>

#include "base/disjoint_sets.h"
#include "evaluate/self_intersections.h"
#include "geometry/edges.h"
#include "scene/check_mesh.h"

namespace axial::evaluate {
namespace {

using geometry::for_each_edge;
using geometry::Side;

// True if the face passes the edge from its lower to its higher vertex.
bool is_upwards(const Mesh& mesh, const Side& side) {
  return mesh.faces[side.face][side.corner] == side.low;
}

// The corners of the face at the lower and at the higher vertex of the edge, counted over all
// faces.
std::array<std::size_t, 2> corners_of(const Mesh& mesh, const Side& side) {
  const std::size_t first = std::size_t{3} * side.face, next = (side.corner + 1) % 3;
  if (is_upwards(mesh, side)) return {first + side.corner, first + next};
  return {first + next, first + side.corner};
}

void count_edges(const Mesh& mesh, std::span<const Side> sides, Topology& topology) {
  DisjointSets<std::size_t> border(mesh.vertices.size());
  std::size_t border_vertices = 0, joined = 0;
  std::vector<bool> on_border(mesh.vertices.size(), false);
  const auto mark = [&](std::uint32_t vertex) {
    if (!on_border[vertex]) ++border_vertices;
    on_border[vertex] = true;
  };
  for_each_edge(sides, [&](std::span<const Side> edge) {
    ++topology.edges;
    if (edge.size() > 2) ++topology.non_manifold_edges;
    if (edge.size() == 2 && is_upwards(mesh, edge[0]) == is_upwards(mesh, edge[1]))
      ++topology.inconsistent_edges;
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
  if (mesh.faces.empty()) return;
  DisjointSets<std::size_t> corners(3 * mesh.faces.size());
  std::vector<std::uint8_t> fans(mesh.vertices.size(), 0);  // 2: more than one
  for_each_edge(sides, [&](std::span<const Side> edge) {
    if (edge.size() > 2) fans[edge[0].low] = fans[edge[0].high] = 2;
    if (edge.size() != 2) return;
    const auto a = corners_of(mesh, edge[0]), b = corners_of(mesh, edge[1]);
    corners.join(a[0], b[0]);
    corners.join(a[1], b[1]);
  });
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k)
      if (corners.root(3 * f + k) == 3 * f + k) {
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
  const std::vector<Side> sides = geometry::sides_of(whole.faces);
  count_edges(whole, sides, topology);
  topology.components = count_components(sides, whole.faces.size());
  count_vertices(whole, sides, topology);
  topology.self_intersecting_faces = self_intersecting_faces(whole).size();
  return topology;
}

}  // namespace axial::evaluate
