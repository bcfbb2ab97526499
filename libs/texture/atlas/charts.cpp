// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture/atlas/charts.h"

#include <algorithm>
#include <cmath>

#include "base/disjoint_sets.h"
#include "base/parallel.h"
#include "scene/camera_model.h"
#include "texture/faces/labels.h"

namespace axial::texture {
namespace {

// Numbers the charts in the order of their first faces.
void number_charts(std::span<const FacePair> pairs, std::span<const std::uint32_t> labels,
                   Charts& result) {
  DisjointSets<std::uint32_t> sets(labels.size());
  for (const FacePair& p : pairs)
    if (labels[p.a] == labels[p.b]) sets.join(p.a, p.b);
  result.chart_of.assign(labels.size(), kNoChart);
  for (std::uint32_t f = 0; f < labels.size(); ++f) {
    if (labels[f] == kNoView) continue;
    const std::uint32_t root = sets.root(f);
    if (root == f) {
      result.chart_of[f] = static_cast<std::uint32_t>(result.charts.size());
      result.charts.push_back({labels[f], {}});
    }
    result.chart_of[f] = result.chart_of[root];
  }
}

void list_faces(Charts& result) {
  result.faces = geometry::lists_of(result.charts.size(), [&](const auto& add) {
    for (std::uint32_t f = 0; f < result.chart_of.size(); ++f)
      if (result.chart_of[f] != kNoChart) add(result.chart_of[f], f);
  });
}

// The nodes of one chart after the other.
void make_nodes(const Mesh& mesh, Charts& result) {
  result.corners.assign(mesh.faces.size(), {});
  std::vector<std::uint32_t> vertices;
  for (std::uint32_t chart = 0; chart < result.charts.size(); ++chart) {
    const std::span<const std::uint32_t> faces = result.faces.of(chart);
    vertices.clear();
    for (const std::uint32_t f : faces)
      vertices.insert(vertices.end(), mesh.faces[f].begin(), mesh.faces[f].end());
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    const auto first = static_cast<std::uint32_t>(result.nodes.size());
    for (const std::uint32_t v : vertices)
      result.nodes.push_back({v, chart, Eigen::Vector2f::Zero()});
    for (const std::uint32_t f : faces)
      for (std::size_t k = 0; k < 3; ++k)
        result.corners[f][k] =
            first + static_cast<std::uint32_t>(
                        std::ranges::lower_bound(vertices, mesh.faces[f][k]) - vertices.begin());
  }
}

void project_nodes(const Mesh& mesh, std::span<const View> views, Charts& result) {
  std::vector<std::vector<std::uint32_t>> nodes_of(views.size());
  for (std::uint32_t n = 0; n < result.nodes.size(); ++n)
    nodes_of[result.charts[result.nodes[n].chart].view].push_back(n);
  parallel_for(views.size(), [&](std::size_t v) {
    if (nodes_of[v].empty()) return;
    std::visit(
        [&](const auto& camera) {
          for (const std::uint32_t n : nodes_of[v]) {
            const Eigen::Vector3d point = mesh.vertices[result.nodes[n].vertex].cast<double>();
            result.nodes[n].pixel =
                camera.project(views[v].pose.to_camera(point)).pixel.template cast<float>();
          }
        },
        make_camera<double>(views[v].camera));
  });
}

void find_rects(Charts& result) {
  std::vector<Eigen::Vector2f> low(result.charts.size(), Eigen::Vector2f::Constant(1e9f));
  std::vector<Eigen::Vector2f> high(result.charts.size(), Eigen::Vector2f::Constant(-1e9f));
  for (const Node& node : result.nodes) {
    low[node.chart] = low[node.chart].cwiseMin(node.pixel);
    high[node.chart] = high[node.chart].cwiseMax(node.pixel);
  }
  for (std::size_t c = 0; c < result.charts.size(); ++c) {
    const int x = static_cast<int>(std::floor(low[c].x())) - kBorder;
    const int y = static_cast<int>(std::floor(low[c].y())) - kBorder;
    result.charts[c].rect = {x, y, static_cast<int>(std::ceil(high[c].x())) + kBorder + 1 - x,
                             static_cast<int>(std::ceil(high[c].y())) + kBorder + 1 - y};
  }
}

// The nodes of the edge's vertices in a face.
std::array<std::uint32_t, 2> nodes_of_edge(const Charts& charts, const Mesh& mesh,
                                           std::uint32_t face, const FacePair& pair) {
  std::array<std::uint32_t, 2> nodes{};
  for (std::size_t k = 0; k < 3; ++k) {
    if (mesh.faces[face][k] == pair.from) nodes[0] = charts.corners[face][k];
    if (mesh.faces[face][k] == pair.to) nodes[1] = charts.corners[face][k];
  }
  return nodes;
}

}  // namespace

Charts make_charts(const Mesh& mesh, std::span<const FacePair> pairs,
                   std::span<const std::uint32_t> labels, std::span<const View> views) {
  Charts result;
  number_charts(pairs, labels, result);
  list_faces(result);
  make_nodes(mesh, result);
  project_nodes(mesh, views, result);
  find_rects(result);
  return result;
}

std::uint64_t bytes_of_charts(std::uint64_t faces, std::uint64_t nodes) {
  // Of a face: sets, chart, corners and list. A chart has at least one node; arrays that grow are
  // in memory twice.
  return faces * (4 + 4 + 12 + 4) +
         nodes * (2 * sizeof(Node) + 2 * sizeof(Chart) + 2 * sizeof(Eigen::Vector2f) + 3 * 4);
}

std::uint64_t most_nodes(const Mesh& mesh, std::span<const FacePair> pairs,
                         std::span<const std::uint32_t> labels) {
  // Each end of a seam adds a node at most.
  const auto seams = std::ranges::count_if(
      pairs, [&](const FacePair& pair) { return labels[pair.a] != labels[pair.b]; });
  return mesh.vertices.size() + 2 * static_cast<std::uint64_t>(seams);
}

std::vector<Seam> find_seams(const Charts& charts, const Mesh& mesh,
                             std::span<const FacePair> pairs) {
  std::vector<Seam> seams;
  for (const FacePair& pair : pairs) {
    const std::uint32_t a = charts.chart_of[pair.a], b = charts.chart_of[pair.b];
    if (a == b || a == kNoChart || b == kNoChart) continue;
    seams.push_back(
        {nodes_of_edge(charts, mesh, pair.a, pair), nodes_of_edge(charts, mesh, pair.b, pair)});
  }
  return seams;
}

}  // namespace axial::texture
