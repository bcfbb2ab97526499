// SPDX-License-Identifier: GPL-3.0-or-later
// Charts: connected faces with colours from one view, and their places in the view's image.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "axial/texture.h"
#include "geometry/lists.h"
#include "scene/mesh.h"
#include "texture/faces/adjacency.h"

namespace axial::texture {

inline constexpr std::uint32_t kNoChart = 0xFFFFFFFFu;  // in Charts::chart_of: the face has none

struct Chart {
  std::uint32_t view = 0;  // index of the view that gives the chart its colours
  // The part of the view's image that contains the chart's faces and a border of kBorder pixels.
  // This part may extend beyond the image.
  cv::Rect rect;
};

inline constexpr int kBorder = 3;  // width of the border around a chart's faces [px]

// A vertex of the mesh in one chart. A vertex at a seam has a node in each of its charts.
struct Node {
  std::uint32_t vertex = 0;  // index into Mesh::vertices
  std::uint32_t chart = 0;   // index into Charts::charts
  // In the image of the chart's view, with pixel centres at integers.
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();
};

struct Charts {
  std::vector<Chart> charts;
  std::vector<Node> nodes;              // ordered by chart, then by vertex
  std::vector<std::uint32_t> chart_of;  // one per face; kNoChart: no view sees it
  // One per face: the indices of the nodes of its corners. No meaning for a face without chart.
  std::vector<std::array<std::uint32_t, 3>> corners;
  geometry::Lists<> faces;  // of each chart, in ascending order
};

// Makes the charts of a labelling. `labels` contains for each face the index of its view, or
// kNoView (labels.h). `pairs`: the result of face_pairs(). A chart is a maximal set of faces with
// the same view that are connected through `pairs`. Charts are in the order of their first faces.
// Node::pixel is the exact projection of the vertex by the camera of the chart's view.
Charts make_charts(const Mesh& mesh, std::span<const FacePair> pairs,
                   std::span<const std::uint32_t> labels, std::span<const View> views);

// The memory [bytes] of make_charts() with its result. `nodes`: the number of nodes.
std::uint64_t bytes_of_charts(std::uint64_t faces, std::uint64_t nodes);

// An upper bound of the number of nodes that make_charts() makes. Only of a mesh with vertices that
// are not manifold, there can be more.
std::uint64_t most_nodes(const Mesh& mesh, std::span<const FacePair> pairs,
                         std::span<const std::uint32_t> labels);

// An edge between a face of chart a and a face of another chart b.
struct Seam {
  // The indices of the edge's two nodes in chart a, and in chart b. The first node belongs to the
  // vertex FacePair::from, and the second to FacePair::to.
  std::array<std::uint32_t, 2> a{}, b{};
};

// Returns all seams, in the order of `pairs`. Chart a of a seam is the chart of the face
// FacePair::a, and chart b is the chart of FacePair::b. An edge of a face without chart is no seam.
std::vector<Seam> find_seams(const Charts& charts, const Mesh& mesh,
                             std::span<const FacePair> pairs);

}  // namespace axial::texture
