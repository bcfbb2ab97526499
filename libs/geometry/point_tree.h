// SPDX-License-Identifier: GPL-3.0-or-later
// The k-d tree of nanoflann for points in space.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <nanoflann.hpp>
#include <span>

namespace axial::geometry {

// The form in which nanoflann reads points. `points` must outlive the tree.
struct PointSet {
  std::span<const Eigen::Vector3f> points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  float kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return points[i][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

// Finds points by their indices. `Distance`: the type in which squared distances are summed.
template <class Distance = float>
using PointTree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, PointSet, Distance>,
                                        PointSet, 3, std::uint32_t>;

}  // namespace axial::geometry
