// SPDX-License-Identifier: GPL-3.0-or-later
// Flat calibration targets, and where photographs show their corners.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace axial::calibrate {

enum class BoardKind { checkerboard, charuco, apriltags };

// A target, in metres. Its corners lie in the plane z = 0.
struct Board {
  BoardKind kind = BoardKind::checkerboard;
  // Checkerboard: inner corners. ChArUco: squares. AprilTags: tags.
  int columns = 0, rows = 0;
  double size = 0;         // side of a square, or of a tag with its black border [m]
  double second = 0;       // ChArUco: side of a marker. AprilTags: gap between tags [m]
  std::string dictionary;  // of markers, as OpenCV names it: "4X4_50", "APRILTAG_36h11"
};

// Reads
//
//     checkerboard:COLUMNSxROWS:SQUARE                     inner corners
//     charuco:COLUMNSxROWS:SQUARE:MARKER[:DICTIONARY]      squares; default 4X4_50
//     apriltags:COLUMNSxROWS:TAG:GAP[:DICTIONARY]          default APRILTAG_36h11
//
// with lengths in metres. Markers are numbered from 0, row by row. Error that names `text` and what
// is wrong with it.
Board parse_board(const std::string& text);

// All corners [m], in the order of their numbers. ChArUco: of the squares. AprilTags: four a tag.
std::vector<Eigen::Vector3d> corners_of(const Board& board);

// One corner in a photograph; pixel centres at integers.
struct Corner {
  std::size_t number = 0;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
};

// The corners that a photograph shows, to fractions of a pixel. None where it shows no board: a
// checkerboard is found whole or not at all, the others in parts.
std::vector<Corner> find_corners(const cv::Mat1b& photograph, const Board& board);

}  // namespace axial::calibrate
