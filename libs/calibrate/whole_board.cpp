// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibrate/whole_board.h"

#include <algorithm>
#include <limits>
#include <opencv2/calib3d.hpp>

#include "calibrate/refine_corners.h"

namespace axial::calibrate {
namespace {

// The least distance [px] between neighbours in rows and columns.
double least_spacing(const std::vector<cv::Point2f>& corners, cv::Size size) {
  const auto at = [&](int row, int column) {
    return corners[static_cast<std::size_t>(row * size.width + column)];
  };
  double least = std::numeric_limits<double>::infinity();
  for (int row = 0; row < size.height; ++row)
    for (int column = 0; column < size.width; ++column) {
      if (column > 0) least = std::min(least, cv::norm(at(row, column) - at(row, column - 1)));
      if (row > 0) least = std::min(least, cv::norm(at(row, column) - at(row - 1, column)));
    }
  return least;
}

// True if a detector guessed corners that are hidden. Corners at the border of the
// photograph are not examined.
bool guessed(const cv::Mat1b& photograph, int half, const std::vector<Corner>& corners) {
  constexpr double kHidden = 0.3;  // far above the asymmetry of a visible corner
  std::vector<double> asymmetries;
  for (const Corner& corner : corners)
    if (holds_window(photograph, half, corner.pixel))
      asymmetries.push_back(asymmetry(photograph, half, corner.pixel));
  return !asymmetries.empty() &&
         *std::ranges::max_element(asymmetries) > hidden_above(asymmetries, kHidden);
}

// The corners of a detector, moved to the intersections of edges. Empty if the detector guessed.
std::vector<Corner> exact(const cv::Mat1b& photograph, cv::Size size,
                          std::vector<cv::Point2f>& corners) {
  const int half = window_for(least_spacing(corners, size));
  move_to_edges(photograph, half, corners);
  std::vector<Corner> found;
  found.reserve(corners.size());
  for (const cv::Point2f& p : corners) found.push_back({found.size(), {p.x, p.y}});
  if (guessed(photograph, half, found)) return {};
  return found;
}

}  // namespace

std::vector<Corner> find_whole_board(const cv::Mat1b& photograph, const Board& board) {
  const cv::Size size(board.columns, board.rows);
  constexpr int kFlags =
      cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_EXHAUSTIVE | cv::CALIB_CB_ACCURACY;
  std::vector<cv::Point2f> corners;
  if (!cv::findChessboardCornersSB(photograph, size, corners, kFlags)) return {};
  return exact(photograph, size, corners);
}

std::vector<Corner> find_board_without_margin(const cv::Mat1b& photograph, const Board& board) {
  const cv::Size size(board.columns, board.rows);
  constexpr int kFlags =
      cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_FAST_CHECK;
  std::vector<cv::Point2f> corners;
  if (!cv::findChessboardCorners(photograph, size, corners, kFlags)) return {};
  return exact(photograph, size, corners);
}

}  // namespace axial::calibrate
