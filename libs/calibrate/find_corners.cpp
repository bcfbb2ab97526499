// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "calibrate/board.h"
#include "calibrate/marker_board.h"

namespace axial::calibrate {
namespace {

// The older detector, which copes with boards that have hardly any margin.
bool find_and_refine(const cv::Mat1b& photograph, cv::Size size,
                     std::vector<cv::Point2f>& corners) {
  constexpr int kFlags =
      cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_FAST_CHECK;
  if (!cv::findChessboardCorners(photograph, size, corners, kFlags)) return false;
  // Half of the least distance between neighbours: the window must not reach another corner.
  double least = 1e9;
  for (std::size_t i = 1; i < corners.size(); ++i)
    least = std::min(least, cv::norm(corners[i] - corners[i - 1]));
  const int half = std::clamp(static_cast<int>(least / 3), 2, 11);
  cv::cornerSubPix(photograph, corners, {half, half}, {-1, -1},
                   {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 50, 1e-3});
  return true;
}

}  // namespace

std::vector<Corner> find_corners(const cv::Mat1b& photograph, const Board& board) {
  if (board.kind != BoardKind::checkerboard) return find_marker_corners(photograph, board);
  const cv::Size size(board.columns, board.rows);
  constexpr int kFlags =
      cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_EXHAUSTIVE | cv::CALIB_CB_ACCURACY;
  std::vector<cv::Point2f> corners;
  if (!cv::findChessboardCornersSB(photograph, size, corners, kFlags) &&
      !find_and_refine(photograph, size, corners))
    return {};
  std::vector<Corner> found;
  for (const cv::Point2f& p : corners) found.push_back({found.size(), {p.x, p.y}});
  return found;
}

}  // namespace axial::calibrate
