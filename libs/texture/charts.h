// SPDX-License-Identifier: GPL-3.0-or-later
// Charts: connected faces with colours from one view, and their places in the view's image.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "scene/mesh.h"
#include "texture/adjacency.h"
#include "texture/views.h"

namespace axial::texture {

inline constexpr std::uint32_t kNoChart = 0xFFFFFFFFu;

struct Chart {
  std::uint32_t view = 0;
  // The part of the view's image that contains the chart's faces and a border of kBorder pixels.
  // This part may extend beyond the image.
  cv::Rect rect;
};

inline constexpr int kBorder = 3;  // [px]

// A vertex of the mesh in one chart. A vertex at a seam has a node in each of its charts.
struct Node {
  std::uint32_t vertex = 0;
  std::uint32_t chart = 0;
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();  // in the image of the chart's view
};

struct Charts {
  std::vector<Chart> charts;
  std::vector<Node> nodes;                            // by chart, then by vertex
  std::vector<std::uint32_t> chart_of;                // one per face; kNoChart: no view sees it
  std::vector<std::array<std::uint32_t, 3>> corners;  // one per face: nodes; unused without chart
  std::vector<std::uint32_t> faces;                   // the faces with a chart, by chart
  std::vector<std::uint32_t> face_begin;  // those of chart c: [face_begin[c], face_begin[c + 1])

  std::span<const std::uint32_t> faces_of(std::size_t chart) const {
    return std::span(faces).subspan(face_begin[chart], face_begin[chart + 1] - face_begin[chart]);
  }
};

// Makes the charts of a labelling. `labels` contains for each face the index of its view, or
// kNoView (labels.h). `pairs`: of face_pairs(). A chart is a maximal set of faces with the same
// view that are connected through `pairs`. Charts are in the order of their first faces. The pixels
// of the nodes are projected by the exact cameras of `views`.
Charts make_charts(const Mesh& mesh, std::span<const FacePair> pairs,
                   std::span<const std::uint32_t> labels, std::span<const View> views);

// The memory [bytes] of make_charts() with its result. `nodes`: the number of nodes.
std::uint64_t bytes_of_charts(std::uint64_t faces, std::uint64_t nodes);

// An upper bound of the number of nodes that make_charts() makes. Only of a mesh with vertices that
// are not manifold, there can be more.
std::uint64_t most_nodes(const Mesh& mesh, std::span<const FacePair> pairs,
                         std::span<const std::uint32_t> labels);

// A common edge of two faces of different charts, chart a and chart b. The order of an edge's two
// vertices is that of FacePair: `from`, then `to`.
struct Seam {
  std::array<std::uint32_t, 2> a{}, b{};  // the nodes of the edge's two vertices in either chart
};

// All seams, in the order of `pairs`. Chart a is that of FacePair::a, and chart b that of
// FacePair::b. An edge of a face without chart is no seam.
std::vector<Seam> find_seams(const Charts& charts, const Mesh& mesh,
                             std::span<const FacePair> pairs);

}  // namespace axial::texture
