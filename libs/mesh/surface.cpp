// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/surface.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "base/disjoint_sets.h"
#include "base/order_statistics.h"

namespace axial::mesh {
namespace {

using Triangle = std::array<std::uint32_t, 3>;
constexpr std::uint32_t kNone = 0xFFFFFFFFu;

struct Facet {
  std::uint32_t cell;  // free
  std::uint32_t i;     // the corner of `cell` opposite of the facet
};

// The corners opposite of corner `i`, counter-clockwise as seen from that corner. The corners of a
// finite tetrahedron have positive orientation: seen from the last corner, the first three are
// counter-clockwise.
Triangle corners_of(const Tetrahedra& tetrahedra, const Facet& facet) {
  const Tetrahedra::Four& cell = tetrahedra.corners[facet.cell];
  const std::size_t i = facet.i;
  Triangle corners{cell[(i + 1) & 3], cell[(i + 2) & 3], cell[(i + 3) & 3]};
  if (i % 2 == 0) std::swap(corners[1], corners[2]);
  return corners;
}

std::vector<Facet> facets_between(const Tetrahedra& tetrahedra, const std::vector<bool>& occupied) {
  std::vector<Facet> facets;
  for (std::uint32_t cell = 0; cell < tetrahedra.size(); ++cell) {
    if (occupied[cell]) continue;
    for (std::uint32_t i = 0; i < 4; ++i) {
      if (!occupied[tetrahedra.neighbours[cell][i]]) continue;
      const Triangle corners = corners_of(tetrahedra, {cell, i});
      if (std::ranges::find(corners, Tetrahedra::kInfinity) == corners.end())
        facets.push_back({cell, i});
    }
  }
  return facets;
}

class SurfaceBuilder {
 public:
  SurfaceBuilder(const Tetrahedra& tetrahedra, const std::vector<bool>& occupied,
                 const std::vector<Facet>& facets)
      : tetrahedra_(tetrahedra),
        occupied_(occupied),
        facets_(facets),
        number_(tetrahedra.size(), Tetrahedra::Four{kNone, kNone, kNone, kNone}),
        sets_(3 * facets.size()) {
    for (std::uint32_t f = 0; f < facets.size(); ++f) number_[facets[f].cell][facets[f].i] = f;
  }

  Surface build(std::span<const Eigen::Vector3f> points) {
    for (std::uint32_t f = 0; f < facets_.size(); ++f)
      for (std::uint32_t k = 0; k < 3; ++k) join_across(f, k);
    Surface surface;
    std::vector<std::uint32_t> vertex_of(3 * facets_.size(), kNone);
    for (std::uint32_t f = 0; f < facets_.size(); ++f) {
      const Triangle corners = corners_of(tetrahedra_, facets_[f]);
      Triangle face{};
      for (std::uint32_t k = 0; k < 3; ++k) {
        std::uint32_t& vertex = vertex_of[sets_.root(3 * f + k)];
        if (vertex == kNone) {
          vertex = static_cast<std::uint32_t>(surface.points.size());
          surface.points.push_back(corners[k]);
          surface.mesh.vertices.push_back(points[corners[k]]);
        }
        face[k] = vertex;
      }
      surface.mesh.faces.push_back(face);
    }
    return surface;
  }

 private:
  // Joins the corners at the ends of the edge opposite of corner k of facet f with the corners of
  // the next facet around the edge.
  void join_across(std::uint32_t f, std::uint32_t k) {
    const Triangle corners = corners_of(tetrahedra_, facets_[f]);
    const std::uint32_t next = next_facet(facets_[f], corners[k]);
    if (next == kNone) return;
    const Triangle others = corners_of(tetrahedra_, facets_[next]);
    for (std::uint32_t end = 1; end < 3; ++end) {
      const std::uint32_t at = (k + end) % 3;
      const auto there = std::ranges::find(others, corners[at]) - others.begin();
      sets_.join(3 * f + at, 3 * next + static_cast<std::uint32_t>(there));
    }
  }

  // Turns around the edge of `facet` opposite of its corner `apex`, through occupied tetrahedra, to
  // the next facet. kNone if that facet is left out.
  std::uint32_t next_facet(const Facet& facet, std::uint32_t apex) const {
    std::uint32_t from = facet.cell, cell = tetrahedra_.neighbours[from][facet.i];
    for (;;) {
      const auto entry = static_cast<std::size_t>(tetrahedra_.place_of_neighbour(cell, from));
      const auto exit = static_cast<std::size_t>(tetrahedra_.place(cell, apex));
      apex = tetrahedra_.corners[cell][entry];
      from = cell;
      cell = tetrahedra_.neighbours[from][exit];
      if (!occupied_[cell])
        return number_[cell][static_cast<std::size_t>(tetrahedra_.place_of_neighbour(cell, from))];
    }
  }

  const Tetrahedra& tetrahedra_;
  const std::vector<bool>& occupied_;
  const std::vector<Facet>& facets_;
  std::vector<Tetrahedra::Four> number_;  // of the facet, or kNone
  DisjointSets<std::uint32_t> sets_;      // corners of facets that are one vertex
};

float longest_edge(const Triangle& corners, std::span<const Eigen::Vector3f> points,
                   std::span<const float> widths) {
  float longest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t a = corners[i], b = corners[(i + 1) % 3];
    longest = std::max(longest, (points[a] - points[b]).norm() / std::min(widths[a], widths[b]));
  }
  return longest;
}

}  // namespace

Surface surface_of(const Tetrahedra& tetrahedra, std::span<const Eigen::Vector3f> points,
                   const std::vector<bool>& occupied) {
  const std::vector<Facet> facets = facets_between(tetrahedra, occupied);
  return SurfaceBuilder(tetrahedra, occupied, facets).build(points);
}

Surface surface_without_long_edges(const Tetrahedra& tetrahedra,
                                   std::span<const Eigen::Vector3f> points,
                                   std::span<const float> widths, const std::vector<bool>& occupied,
                                   double factor) {
  std::vector<Facet> facets = facets_between(tetrahedra, occupied);
  if (factor > 0 && !facets.empty()) {
    std::vector<float> lengths;
    lengths.reserve(facets.size());
    for (const Facet& facet : facets)
      lengths.push_back(longest_edge(corners_of(tetrahedra, facet), points, widths));
    const float limit = static_cast<float>(factor / 3) * upper_median(lengths);
    std::size_t f = 0;
    std::erase_if(facets, [&](const Facet&) { return lengths[f++] > limit; });
  }
  return SurfaceBuilder(tetrahedra, occupied, facets).build(points);
}

}  // namespace axial::mesh
