// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: the part of a LAS 1.4 file that precedes its points: the public header block
// and the variable length records. Source of all places and numbers: ASPRS, LAS Specification 1.4,
// R15.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "bytes/private/only_for_io.h"

namespace axial::io {

// The properties that a file has for each point besides its position. `views` is the number of
// views; `errors` are both properties, error and confidence.
struct LasLayout {
  bool colors = false, normals = false, views = false, errors = false;
};

// A coordinate x of the world is stored as the integer nearest to (x - offset) / scale.
struct LasGrid {
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  double scale = 1e-6;  // the same for x, y and z

  // Whether the integers of `x` have 32 bits. False for a position that is not finite.
  bool holds(const Eigen::Vector3d& x) const;
  // Precondition: holds(x).
  std::array<std::int32_t, 3> stored(const Eigen::Vector3d& x) const;
  Eigen::Vector3d world(const std::array<std::int32_t, 3>& stored) const;
};

// The grid for points between the corners `low` and `high` of a box [world]: the offset is the
// rounded middle of the box, and the scale is the finest of 1e-6, 1e-5, 1e-4 and 1e-3 for which all
// points have integers of 32 bits. Nothing if the box is too large, or is not finite.
std::optional<LasGrid> las_grid(const Eigen::Vector3d& low, const Eigen::Vector3d& high);

struct LasHeader {
  LasLayout layout;
  LasGrid grid;
  std::string crs;           // WKT, at most kMostCrs bytes; empty: none
  std::uint64_t points = 0;  // of the file
  Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = Eigen::Vector3d::Zero();  // [world]

  static constexpr std::size_t kMostCrs = 65534;  // a record counts its bytes in 16 bits
};

// The bytes of a point in a file with this layout.
std::size_t bytes_of_point(const LasLayout& layout);

// The bytes that precede the points. Their number depends on `layout` and `crs` alone. The date of
// the file is 0, which means unknown, so that the same cloud gives the same bytes.
std::string las_header(const LasHeader& header);

}  // namespace axial::io
