// SPDX-License-Identifier: GPL-3.0-or-later
// Flat calibration targets, and the detection of their corners in photographs.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace axial::calibrate {

enum class BoardKind { checkerboard, charuco, apriltags };

// A target. Lengths are in metres. Its corners lie in the plane z = 0.
struct Board {
  BoardKind kind = BoardKind::checkerboard;
  // Checkerboard: inner corners. ChArUco: squares. AprilTags: tags.
  int columns = 0, rows = 0;
  double size = 0;         // side of a square, or of a tag with its black border [m]
  double second = 0;       // ChArUco: side of a marker. AprilTags: gap between tags [m]
  std::string dictionary;  // OpenCV's name of the set of markers: "4X4_50", "APRILTAG_36h11"
};

// Reads a board from a text of one of these forms, with lengths in metres:
//
//     checkerboard:COLUMNSxROWS:SQUARE                     inner corners
//     charuco:COLUMNSxROWS:SQUARE:MARKER[:DICTIONARY]      squares; default 4X4_50
//     apriltags:COLUMNSxROWS:TAG:GAP[:DICTIONARY]          tags; default APRILTAG_36h11
//
// Markers are numbered from 0, row by row. If `text` has none of these forms, throws an Error that
// contains `text` and the reason.
Board parse_board(const std::string& text);

// All corners [m], in the order of their numbers. ChArUco: the inner corners of the squares.
// AprilTags: the four corners of each tag.
std::vector<Eigen::Vector3d> corners_of(const Board& board);

// One corner in a photograph. The centres of pixels have integer coordinates.
struct Corner {
  std::size_t number = 0;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
};

// Returns the corners in a photograph, to fractions of a pixel. Empty if no board is found. A
// checkerboard must be visible completely. The other boards may be visible in part.
std::vector<Corner> find_corners(const cv::Mat1b& photograph, const Board& board);

}  // namespace axial::calibrate
