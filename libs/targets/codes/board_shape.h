// SPDX-License-Identifier: GPL-3.0-or-later
// Boards, flat targets with many corners, as data.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>

namespace axial::targets {

enum class BoardKind { checkerboard, charuco, apriltags };

// A target. Its corners lie in the plane z = 0 of its own frame, in which x grows along a row and y
// from row to row (see corners_of()).
struct Board {
  BoardKind kind = BoardKind::checkerboard;
  // Checkerboard: numbers of inner corners. ChArUco: of squares. AprilTags: of tags.
  int columns = 0, rows = 0;
  double size = 0;  // side of a square, or of a tag with its black border [m]
  // ChArUco: side of a marker [m]. AprilTags: gap between tags [m]. Checkerboard: height of a
  // square [m], if it differs from its width `size`; else 0.
  double second = 0;
  // OpenCV's name of the set of markers: "4X4_50", "APRILTAG_36h11". Checkerboard: empty.
  std::string dictionary;
};

// One corner of a board in a photograph.
struct Corner {
  std::size_t number = 0;  // index into corners_of()
  // In pixels of the photograph, whose centres have integer coordinates.
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
};

}  // namespace axial::targets
