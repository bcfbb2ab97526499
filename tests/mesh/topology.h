// SPDX-License-Identifier: GPL-3.0-or-later
// Topological properties of a mesh, counted from its faces by brute force.
#pragma once

#include <array>
#include <map>
#include <set>
#include <utility>

#include "scene/mesh.h"

namespace axial::test {

struct MeshFacts {
  std::size_t border_edges = 0;  // edges with one face
  // Edges that two or more faces pass in the same direction: edges of more than two faces, or of
  // two faces with different orientations.
  std::size_t bad_edges = 0;
  std::size_t bad_vertices = 0;  // vertices whose faces do not form one fan
  std::size_t unused_vertices = 0;
  long euler = 0;  // vertices - edges + faces
};

inline std::size_t fans_at(const std::vector<std::array<std::uint32_t, 2>>& links) {
  std::map<std::uint32_t, std::uint32_t> parent;
  const auto root = [&](std::uint32_t v) {
    while (parent.at(v) != v) v = parent.at(v);
    return v;
  };
  for (const auto& [a, b] : links) {
    parent.emplace(a, a);
    parent.emplace(b, b);
    parent[root(a)] = root(b);
  }
  std::set<std::uint32_t> roots;
  for (const auto& [v, p] : parent) roots.insert(root(v));
  return roots.size();
}

inline MeshFacts facts_of(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> directed;
  std::vector<std::vector<std::array<std::uint32_t, 2>>> links(mesh.vertices.size());
  for (const auto& face : mesh.faces)
    for (std::size_t k = 0; k < 3; ++k) {
      ++directed[{face[k], face[(k + 1) % 3]}];
      links[face[k]].push_back({face[(k + 1) % 3], face[(k + 2) % 3]});
    }
  MeshFacts facts;
  std::size_t edges = 0;
  for (const auto& [edge, count] : directed) {
    const auto back = directed.find({edge.second, edge.first});
    if (count > 1) ++facts.bad_edges;
    if (back == directed.end()) ++facts.border_edges;
    if (back == directed.end() || edge.first < edge.second) ++edges;
  }
  for (const auto& at : links) {
    if (at.empty()) ++facts.unused_vertices;
    if (fans_at(at) > 1) ++facts.bad_vertices;
  }
  facts.euler = static_cast<long>(mesh.vertices.size() - facts.unused_vertices) -
                static_cast<long>(edges) + static_cast<long>(mesh.faces.size());
  return facts;
}

}  // namespace axial::test
