// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "calibrate/board.h"
#include "calibrate/marker_board.h"

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

// Moves each corner to the intersection of the edges around it.
void refine(const cv::Mat1b& photograph, cv::Size size, std::vector<cv::Point2f>& corners) {
  // The window must not reach another corner: a third of the least spacing to each side.
  const int half = std::clamp(static_cast<int>(least_spacing(corners, size) / 3), 2, 11);
  cv::cornerSubPix(photograph, corners, {half, half}, {-1, -1},
                   {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 50, 1e-3});
}

// OpenCV's older detector finds boards that have hardly any margin.
bool find_at_the_margin(const cv::Mat1b& photograph, cv::Size size,
                        std::vector<cv::Point2f>& corners) {
  constexpr int kFlags =
      cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_FAST_CHECK;
  return cv::findChessboardCorners(photograph, size, corners, kFlags);
}

}  // namespace

std::vector<Corner> find_corners(const cv::Mat1b& photograph, const Board& board) {
  if (board.kind != BoardKind::checkerboard) return find_marker_corners(photograph, board);
  const cv::Size size(board.columns, board.rows);
  constexpr int kFlags =
      cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_EXHAUSTIVE | cv::CALIB_CB_ACCURACY;
  std::vector<cv::Point2f> corners;
  if (!cv::findChessboardCornersSB(photograph, size, corners, kFlags) &&
      !find_at_the_margin(photograph, size, corners))
    return {};
  refine(photograph, size, corners);
  std::vector<Corner> found;
  found.reserve(corners.size());
  for (const cv::Point2f& p : corners) found.push_back({found.size(), {p.x, p.y}});
  return found;
}

}  // namespace axial::calibrate
