// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <limits>
#include <map>
#include <numeric>

#include "base/disjoint_sets.h"
#include "geometry/point_tree.h"
#include "mesh/tile_mesh.h"
#include "private/seam_patch.h"

namespace axial::mesh {
namespace {

constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kCloseGaps = 60;  // gaps of at most this many edges are closed
constexpr int kRings = 6;               // of faces around an unmatched edge that are mended

using Face = std::array<std::uint32_t, 3>;

// A directed edge at a seam, with the numbers of the joined mesh.
struct SeamEdge {
  std::uint32_t from = 0, to = 0;
  std::uint32_t tile = 0;
};

struct Union {
  Mesh mesh;
  std::vector<SeamEdge> seams;
};

// The meshes side by side.
Union side_by_side(std::vector<TileMesh> tiles) {
  Union all;
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    TileMesh tile = std::move(tiles[t]);
    tiles[t] = {};
    const auto first = static_cast<std::uint32_t>(all.mesh.vertices.size());
    all.mesh.vertices.insert(all.mesh.vertices.end(), tile.mesh.vertices.begin(),
                             tile.mesh.vertices.end());
    for (const auto& [a, b, c] : tile.mesh.faces)
      all.mesh.faces.push_back({first + a, first + b, first + c});
    for (const auto& [from, to] : tile.seams)
      all.seams.push_back({first + from, first + to, static_cast<std::uint32_t>(t)});
  }
  return all;
}

// For each seam edge the counterpart in another tile, or kNobody.
std::vector<std::uint32_t> counterparts(const Union& all) {
  const std::vector<Eigen::Vector3f>& at = all.mesh.vertices;
  std::vector<Eigen::Vector3f> middles;
  for (const SeamEdge& edge : all.seams) middles.push_back((at[edge.from] + at[edge.to]) / 2);
  std::vector<std::uint32_t> other(all.seams.size(), kNobody);
  if (all.seams.empty()) return other;
  const geometry::PointSet set{middles};
  const geometry::PointTree<> tree(3, set, {16});
  nanoflann::SearchParams params;
  params.sorted = false;
  std::vector<std::pair<std::uint32_t, float>> found;
  for (std::uint32_t i = 0; i < all.seams.size(); ++i) {
    if (other[i] != kNobody) continue;
    const SeamEdge& edge = all.seams[i];
    const float limit = 1e-3f * (at[edge.from] - at[edge.to]).norm();
    found.clear();
    tree.radiusSearch(middles[i].data(), limit * limit + 1e-30f, found, params);
    std::ranges::sort(found, {}, [](const auto& hit) { return std::pair(hit.second, hit.first); });
    for (const auto& [k, distance2] : found) {
      const SeamEdge& back = all.seams[k];
      if (back.tile == edge.tile || other[k] != kNobody) continue;
      if ((at[edge.from] - at[back.to]).norm() > limit) continue;
      if ((at[edge.to] - at[back.from]).norm() > limit) continue;
      other[i] = k;
      other[k] = i;
      break;
    }
  }
  return other;
}

// Gives both sides of matched seams the same vertices: of several the first.
void weld(Union& all, const std::vector<std::uint32_t>& other) {
  DisjointSets<std::uint32_t> sets(all.mesh.vertices.size());
  for (std::size_t i = 0; i < all.seams.size(); ++i) {
    if (other[i] == kNobody) continue;
    sets.join(all.seams[i].from, all.seams[other[i]].to);
    sets.join(all.seams[i].to, all.seams[other[i]].from);
  }
  for (Face& face : all.mesh.faces)
    for (std::uint32_t& corner : face) corner = sets.root(corner);
  for (SeamEdge& edge : all.seams) {
    edge.from = sets.root(edge.from);
    edge.to = sets.root(edge.to);
  }
}

// Marks the vertices at unmatched seam edges, and at edges that two faces pass in the same
// direction after welding.
std::vector<bool> faulty_vertices(const Union& all, const std::vector<std::uint32_t>& other) {
  std::vector<bool> at_seam(all.mesh.vertices.size(), false), faulty = at_seam;
  for (std::size_t i = 0; i < all.seams.size(); ++i) {
    at_seam[all.seams[i].from] = at_seam[all.seams[i].to] = true;
    if (other[i] == kNobody) faulty[all.seams[i].from] = faulty[all.seams[i].to] = true;
  }
  std::vector<bool> beside_seam;
  for (const Face& face : all.mesh.faces)
    beside_seam.push_back(
        std::ranges::any_of(face, [&](std::uint32_t corner) { return at_seam[corner]; }));
  const std::vector<std::uint64_t> edges = directed_edges(all.mesh, beside_seam);
  for (std::size_t i = 0; i + 1 < edges.size(); ++i)
    if (edges[i] == edges[i + 1])
      faulty[edges[i] >> 32] = faulty[static_cast<std::uint32_t>(edges[i])] = true;
  for (const Face& face : all.mesh.faces)  // corners that welding has made one
    if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0])
      for (const std::uint32_t corner : face) faulty[corner] = true;
  return faulty;
}

// The faces within kRings of the marked vertices.
std::vector<bool> faces_around(const Mesh& mesh, std::vector<bool> vertices) {
  std::vector<bool> taken(mesh.faces.size(), false);
  for (int ring = 0; ring < kRings; ++ring) {
    std::vector<bool> next = vertices;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      const Face& face = mesh.faces[f];
      if (!vertices[face[0]] && !vertices[face[1]] && !vertices[face[2]]) continue;
      taken[f] = true;
      for (const std::uint32_t corner : face) next[corner] = true;
    }
    vertices = std::move(next);
  }
  return taken;
}

// The corners of faces, as (face, number of the corner).
using Corners = std::vector<std::pair<std::size_t, std::size_t>>;

// Divides the corners of one vertex into fans: groups of faces that are connected by common edges.
std::vector<Corners> fans_of(const Mesh& mesh, const Corners& corners) {
  DisjointSets<std::uint32_t> sets(corners.size());
  std::map<std::uint32_t, std::uint32_t> first_at;  // by the other end of an edge
  for (std::uint32_t i = 0; i < corners.size(); ++i)
    for (const std::size_t step : {1u, 2u}) {
      const auto& [face, k] = corners[i];
      const auto [entry, is_new] = first_at.emplace(mesh.faces[face][(k + step) % 3], i);
      if (!is_new) sets.join(entry->second, i);
    }
  std::map<std::uint32_t, Corners> fans;
  for (std::uint32_t i = 0; i < corners.size(); ++i) fans[sets.root(i)].push_back(corners[i]);
  std::vector<Corners> result;
  for (auto& [root, fan] : fans) result.push_back(std::move(fan));
  return result;
}

// The corners of the marked faces at each vertex that also has faces without a mark.
std::map<std::uint32_t, Corners> corners_at_rim(const Mesh& mesh, const std::vector<bool>& taken) {
  std::vector<bool> inside(mesh.vertices.size(), false), outside = inside;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (const std::uint32_t corner : mesh.faces[f]) (taken[f] ? inside : outside)[corner] = true;
  std::map<std::uint32_t, Corners> at;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k)
      if (const std::uint32_t corner = mesh.faces[f][k];
          taken[f] && inside[corner] && outside[corner])
        at[corner].emplace_back(f, k);
  return at;
}

// Marks more faces until the marked faces at each vertex form one fan, or are all of its faces.
// Otherwise the patch would have several vertices at this place.
void mark_whole_fans(const Mesh& mesh, std::vector<bool>& taken) {
  for (bool changed = true; changed;) {
    std::vector<bool> split(mesh.vertices.size(), false);
    changed = false;
    for (const auto& [vertex, corners] : corners_at_rim(mesh, taken))
      if (fans_of(mesh, corners).size() > 1) changed = split[vertex] = true;
    for (std::size_t f = 0; changed && f < mesh.faces.size(); ++f)
      for (const std::uint32_t corner : mesh.faces[f])
        if (split[corner]) taken[f] = true;
  }
}

struct Patch : MeshPart {
  std::vector<bool> fixed;  // per vertex: also a corner of other faces
};

// Takes the faces out of `mesh`.
Patch take_out(Mesh& mesh, const std::vector<bool>& taken) {
  Patch patch{part_of(mesh, taken), {}};
  std::size_t f = 0;
  std::erase_if(mesh.faces, [&](const Face&) { return taken[f++]; });
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const Face& face : mesh.faces)
    for (const std::uint32_t corner : face) used[corner] = true;
  for (const std::uint32_t vertex : patch.vertices) patch.fixed.push_back(used[vertex]);
  return patch;
}

using Place = std::array<float, 3>;

Place place_of(const Eigen::Vector3f& v) {
  return {v.x(), v.y(), v.z()};
}

// Puts the faces of the mended patch into `mesh`. Fixed vertices get their old numbers.
void put_back(const Patch& patch, const Mesh& mended, Mesh& mesh) {
  std::map<Place, std::uint32_t> fixed;
  for (std::size_t v = 0; v < patch.vertices.size(); ++v)
    if (patch.fixed[v]) fixed.emplace(place_of(patch.mesh.vertices[v]), patch.vertices[v]);
  std::vector<std::uint32_t> number;
  for (const Eigen::Vector3f& vertex : mended.vertices) {
    const auto known = fixed.find(place_of(vertex));
    if (known != fixed.end()) {
      number.push_back(known->second);
    } else {
      number.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
      mesh.vertices.push_back(vertex);
    }
  }
  for (const auto& [a, b, c] : mended.faces)
    mesh.faces.push_back({number[a], number[b], number[c]});
}

// Gives each fan of a patch's vertices a vertex of its own. The new vertices move by 1 % of the way
// to the mean of their neighbours.
void split_fans(const Patch& patch, Mesh& mesh) {
  std::map<std::uint32_t, Corners> at;
  for (const std::uint32_t vertex : patch.vertices) at[vertex];
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k)
      if (const auto entry = at.find(mesh.faces[f][k]); entry != at.end())
        entry->second.emplace_back(f, k);
  for (const auto& [vertex, corners] : at) {
    const std::vector<Corners> fans = fans_of(mesh, corners);
    for (std::size_t fan = 1; fan < fans.size(); ++fan) {
      Eigen::Vector3f mean = Eigen::Vector3f::Zero();
      for (const auto& [f, k] : fans[fan])
        for (const std::size_t step : {1u, 2u})
          mean += mesh.vertices[mesh.faces[f][(k + step) % 3]];
      mean /= static_cast<float>(2 * fans[fan].size());
      const Eigen::Vector3f place = mesh.vertices[vertex];
      for (const auto& [f, k] : fans[fan])
        mesh.faces[f][k] = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.emplace_back(place + 0.01f * (mean - place));
    }
  }
}

// Keeps the faces for which kept(face) holds.
void keep_faces(Mesh& mesh, const auto& kept) {
  std::erase_if(mesh.faces, [&](const Face& face) { return !kept(face); });
}

void drop_unused_vertices(Mesh& mesh) {
  std::vector<std::uint32_t> number(mesh.vertices.size(), kNobody);
  for (const Face& face : mesh.faces)
    for (const std::uint32_t corner : face) number[corner] = 0;
  std::uint32_t next = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (number[v] == kNobody) continue;
    number[v] = next;
    mesh.vertices[next++] = mesh.vertices[v];
  }
  mesh.vertices.resize(next);
  for (Face& face : mesh.faces)
    for (std::uint32_t& corner : face) corner = number[corner];
}

double mean_edge(const Mesh& mesh) {
  double sum = 0;
  for (const Face& face : mesh.faces)
    for (std::size_t k = 0; k < 3; ++k)
      sum +=
          static_cast<double>((mesh.vertices[face[k]] - mesh.vertices[face[(k + 1) % 3]]).norm());
  return sum / static_cast<double>(3 * std::max<std::size_t>(mesh.faces.size(), 1));
}

// Removes pieces whose bounding box has a diagonal below `limit`. Returns their number.
std::size_t remove_small_pieces(Mesh& mesh, double limit) {
  if (!(limit > 0)) return 0;
  DisjointSets<std::uint32_t> pieces(mesh.vertices.size());
  for (const auto& [a, b, c] : mesh.faces) {
    pieces.join(a, b);
    pieces.join(b, c);
  }
  std::map<std::uint32_t, Eigen::AlignedBox3f> boxes;
  for (const Face& face : mesh.faces)
    for (const std::uint32_t corner : face)
      boxes[pieces.root(corner)].extend(mesh.vertices[corner]);
  const auto is_large = [&](const Face& face) {
    return static_cast<double>(boxes[pieces.root(face[0])].diagonal().norm()) >= limit;
  };
  const auto small = std::ranges::count_if(boxes, [&](const auto& box) {
    return static_cast<double>(box.second.diagonal().norm()) < limit;
  });
  if (small > 0) keep_faces(mesh, is_large);
  return static_cast<std::size_t>(small);
}

}  // namespace

std::uint64_t bytes_to_join(std::uint64_t vertices) {
  // The meshes of the tiles and the joined mesh, at most twice while an array grows, and the sets
  // of vertices and the numbers of faces.
  return vertices * 120;
}

Mesh join_tiles(std::vector<TileMesh> tiles, const JoinOptions& options, JoinReport* report) {
  JoinReport own;
  JoinReport& facts = report ? *report : own;
  facts = {};
  Union all = side_by_side(std::move(tiles));
  const std::vector<std::uint32_t> other = counterparts(all);
  weld(all, other);
  facts.unmatched = static_cast<std::size_t>(std::ranges::count(other, kNobody));
  facts.seams = facts.unmatched + (other.size() - facts.unmatched) / 2;
  std::vector<bool> taken = faces_around(all.mesh, faulty_vertices(all, other));
  mark_whole_fans(all.mesh, taken);
  Mesh mesh = std::move(all.mesh);
  if (std::ranges::count(taken, true) > 0) {
    const Patch patch = take_out(mesh, taken);
    facts.replaced_faces = patch.mesh.faces.size();
    put_back(patch, mend_patch(patch.mesh, patch.fixed, kCloseGaps), mesh);
    split_fans(patch, mesh);
  }
  facts.removed_components = remove_small_pieces(mesh, options.spurious * mean_edge(mesh));
  drop_unused_vertices(mesh);
  return mesh;
}

}  // namespace axial::mesh
