// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/codes/marker_board.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <opencv2/aruco/charuco.hpp>
#include <opencv2/imgproc.hpp>

#include "base/error.h"
#include "targets/codes/dictionary.h"

namespace axial::targets {
namespace {

using cv::aruco::CharucoBoard;

cv::Ptr<cv::aruco::Dictionary> dictionary_of(const Board& board, const std::string& where) {
  if (const auto number = dictionary_number(board.dictionary)) return dictionary(*number);
  fail("{}: '{}' is not a dictionary of markers of OpenCV (4X4_50, APRILTAG_36h11, ...)", where,
       board.dictionary);
}

cv::Ptr<CharucoBoard> charuco(const Board& board) {
  return CharucoBoard::create(board.columns, board.rows, static_cast<float>(board.size),
                              static_cast<float>(board.second), dictionary_of(board, "board"));
}

struct Markers {
  std::vector<std::vector<cv::Point2f>> corners;
  std::vector<int> ids;
};

Markers find_markers(const cv::Mat1b& photograph, const Board& board, int refinement) {
  const auto parameters = cv::aruco::DetectorParameters::create();
  parameters->cornerRefinementMethod = refinement;
  Markers markers;
  cv::aruco::detectMarkers(photograph, dictionary_of(board, "board"), markers.corners, markers.ids,
                           parameters);
  return markers;
}

Eigen::Vector2d pixel_of(const cv::Point2f& p) {
  return {p.x, p.y};
}

// Half the side [px] of a window around a corner of squares that does not reach a marker. The gap
// to the marker is scaled by the least distance of two neighbouring corners.
int charuco_window(const Board& board, const std::vector<cv::Point2f>& corners,
                   const std::vector<int>& numbers) {
  constexpr int kLeast = 2, kMost = 11;
  const int columns = board.columns - 1;
  double spacing = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (std::size_t j = i + 1; j < corners.size(); ++j) {
      const int apart = std::abs(numbers[i] % columns - numbers[j] % columns) +
                        std::abs(numbers[i] / columns - numbers[j] / columns);
      if (apart == 1) spacing = std::min(spacing, cv::norm(corners[i] - corners[j]));
    }
  if (!std::isfinite(spacing)) return kLeast;
  const double gap = (board.size - board.second) / 2 / board.size;
  return std::clamp(static_cast<int>(gap * spacing), kLeast, kMost);
}

std::vector<Corner> find_charuco(const cv::Mat1b& photograph, const Board& board) {
  // Corners of markers only locate the squares. The corners of squares are refined later.
  const Markers markers = find_markers(photograph, board, cv::aruco::CORNER_REFINE_NONE);
  std::vector<Corner> found;
  if (markers.ids.empty()) return found;
  std::vector<cv::Point2f> corners;
  std::vector<int> numbers;
  cv::aruco::interpolateCornersCharuco(markers.corners, markers.ids, photograph, charuco(board),
                                       corners, numbers);
  if (corners.empty()) return found;
  // OpenCV 4.6 returns these corners shifted by half a pixel to the right and down.
  const int half = charuco_window(board, corners, numbers);
  cv::cornerSubPix(photograph, corners, {half, half}, {-1, -1},
                   {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 50, 1e-3});
  for (std::size_t i = 0; i < numbers.size(); ++i)
    found.push_back({static_cast<std::size_t>(numbers[i]), pixel_of(corners[i])});
  return found;
}

std::vector<Corner> find_tags(const cv::Mat1b& photograph, const Board& board) {
  const Markers markers = find_markers(photograph, board, cv::aruco::CORNER_REFINE_SUBPIX);
  std::vector<Corner> found;
  for (std::size_t i = 0; i < markers.ids.size(); ++i) {
    if (markers.ids[i] >= board.columns * board.rows) continue;  // a marker of another board
    for (std::size_t k = 0; k < 4; ++k)
      found.push_back(
          {4 * static_cast<std::size_t>(markers.ids[i]) + k, pixel_of(markers.corners[i][k])});
  }
  return found;
}

}  // namespace

void check_markers(const Board& board, const std::string& where) {
  const int squares = board.columns * board.rows;
  const int needed = board.kind == BoardKind::charuco ? squares / 2 : squares;
  const int there = dictionary_of(board, where)->bytesList.rows;
  if (needed > there)
    fail("{}: needs {} markers, but the dictionary {} has {}", where, needed, board.dictionary,
         there);
}

// OpenCV has these positions in single precision. They are computed again as whole multiples of the
// lengths, so that they are exact.
std::vector<Eigen::Vector3d> marker_board_corners(const Board& board) {
  std::vector<Eigen::Vector3d> corners;
  if (board.kind == BoardKind::charuco) {
    const cv::Ptr<CharucoBoard> squares = charuco(board);
    for (const cv::Point3f& p : squares->chessboardCorners)
      corners.emplace_back(std::round(p.x / board.size) * board.size,
                           std::round(p.y / board.size) * board.size, 0);
    return corners;
  }
  constexpr std::array<std::array<int, 2>, 4> kAround{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  const double pitch = board.size + board.second;
  for (int row = 0; row < board.rows; ++row)
    for (int column = 0; column < board.columns; ++column)
      for (const auto& [right, down] : kAround)
        corners.emplace_back(column * pitch + right * board.size, row * pitch + down * board.size,
                             0);
  return corners;
}

std::vector<Corner> find_marker_corners(const cv::Mat1b& photograph, const Board& board) {
  return board.kind == BoardKind::charuco ? find_charuco(photograph, board)
                                          : find_tags(photograph, board);
}

}  // namespace axial::targets
