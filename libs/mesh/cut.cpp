// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/cut.h"

#include <maxflow.h>

#include "base/error.h"

namespace axial::mesh {
namespace {

// Boykov and Kolmogorov's algorithm, which keeps its search trees between augmentations. The
// library has only instances whose total flow is an int. The total may exceed its range, and is not
// used.
using Graph = maxflow::Graph<int, int, int>;

void report(const char* message) {
  fail("the cut of the tetrahedra: {}", message);
}

void connect(const Tetrahedra& tetrahedra, const Votes& votes, std::uint32_t cell, Graph& graph) {
  for (std::size_t i = 0; i < 4; ++i) {
    const std::uint32_t next = tetrahedra.neighbours[cell][i];
    if (next < cell) continue;
    const auto back = static_cast<std::size_t>(tetrahedra.place_of_neighbour(next, cell));
    graph.add_edge(static_cast<int>(cell), static_cast<int>(next), votes.facets[cell][i],
                   votes.facets[next][back]);
  }
}

}  // namespace

std::vector<bool> occupied(const Tetrahedra& tetrahedra, const Votes& votes) {
  if (tetrahedra.size() >= (std::size_t{1} << 29))
    fail("{} tetrahedra are too many for the cut", tetrahedra.size());
  const auto cells = static_cast<int>(tetrahedra.size());
  Graph graph(cells, 2 * cells, report);
  graph.add_node(cells);
  for (std::uint32_t cell = 0; cell < tetrahedra.size(); ++cell)
    graph.add_tweights(static_cast<int>(cell), votes.outside[cell], votes.inside[cell]);
  for (std::uint32_t cell = 0; cell < tetrahedra.size(); ++cell)
    connect(tetrahedra, votes, cell, graph);
  graph.maxflow();
  std::vector<bool> result(tetrahedra.size());
  for (int cell = 0; cell < cells; ++cell)
    result[static_cast<std::size_t>(cell)] = graph.what_segment(cell, Graph::SOURCE) == Graph::SINK;
  return result;
}

}  // namespace axial::mesh
