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
  // The part of the image that holds the chart's faces and a border of kBorder pixels. It may
  // extend beyond the image.
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

// Makes the charts of a labelling: `labels` holds a view for each face, or kNoView. Nodes are
// projected by the exact cameras.
Charts make_charts(const Mesh& mesh, std::span<const FacePair> pairs,
                   std::span<const std::uint32_t> labels, std::span<const View> views);

// A common edge of two faces of different charts.
struct Seam {
  std::array<std::uint32_t, 2> a{}, b{};  // nodes of its two vertices in the one and other chart
};

// All seams, in the order of `pairs`.
std::vector<Seam> find_seams(const Charts& charts, const Mesh& mesh,
                             std::span<const FacePair> pairs);

}  // namespace axial::texture
