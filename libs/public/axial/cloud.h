// SPDX-License-Identifier: GPL-3.0-or-later
// Options of the fusion of depth maps to a cloud.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

namespace axial::cloud {

// A half-open box: the points x [world] with low <= rotation * x < high in each component. The
// default is all of space.
struct Tile {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  // rows: the box axes in the world
  Eigen::Vector3d low = Eigen::Vector3d::Constant(-kInfinity);
  Eigen::Vector3d high = Eigen::Vector3d::Constant(kInfinity);

  // False for NaN.
  bool contains(const Eigen::Vector3d& x) const {
    const Eigen::Vector3d along = rotation * x;
    return (along.array() >= low.array()).all() && (along.array() < high.array()).all();
  }
};

// A part of space to which the fusion is restricted.
struct FusionPart {
  Tile tile;   // the points whose positions lie in this box are the result
  Tile reach;  // only pixels whose points lie in this box are processed; larger than `tile`
  // One entry for each FusionView: false if its map has no point in `reach`. Such a view is not
  // processed, and its map is loaded only as a neighbour. Empty: all views are processed. The cloud
  // does not depend on entries that are true without need.
  std::vector<bool> seen_by;
};

// Settings of the fusion.
struct FuseOptions {
  // The number of images that must agree on a point. The image whose pixel gives the point counts
  // as one of them. A value above the number of views is reduced to the number of views. With a
  // value below 2 the maps are merged without tests: every valid pixel becomes a point with one
  // view.
  std::size_t min_views = 3;
  // Also accepts a point on which only two images agree, if no other image disagrees and the point
  // lies in a piece of surface of both maps (see fuse()). Has no effect for min_views up to 2.
  bool two_if_undisputed = true;
  // Depths agree if their difference is below this fraction of the point's depth. Both depths are
  // measured along the ray of the neighbour, the image that is compared.
  double depth_threshold = 0.005;
  double normal_threshold = 40.0 * std::numbers::pi / 180.0;  // largest angle that agrees [rad]
  bool normals = true;                                        // fill PointCloud::normals
  bool errors = false;             // fill PointCloud::errors and confidences
  std::optional<FusionPart> part;  // empty: all of space

  // Limits of memory (see bytes_needed()). The cloud does not depend on them.
  // max_maps: the number of maps in memory at the same time. A view and its neighbours are always
  // in memory together, even if they are more than max_maps.
  // max_loads: the number of simultaneous calls of the providers. 0 counts as 1.
  std::size_t max_maps = std::numeric_limits<std::size_t>::max();
  std::size_t max_loads = 1;
};

}  // namespace axial::cloud
