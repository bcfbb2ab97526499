// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibrate/piece.h"

#include <algorithm>
#include <array>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "calibrate/lattice.h"
#include "calibrate/refine_corners.h"

namespace axial::calibrate {
namespace {

// A corner of the board in the photograph.
struct GridCorner {
  Eigen::Vector2i cell{0, 0};  // column and row
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
};
using Grid = std::vector<GridCorner>;

// The photograph, and copies of it, each with half the width and height of the one before.
std::vector<cv::Mat1b> pyramid(const cv::Mat1b& photograph) {
  constexpr int kLeastSide = 100;  // [px]
  std::vector<cv::Mat1b> levels{photograph};
  while (std::min(levels.back().rows, levels.back().cols) >= 2 * kLeastSide) {
    cv::Mat1b half;
    cv::pyrDown(levels.back(), half);
    levels.push_back(half);
  }
  return levels;
}

Grid grid_in(const cv::Mat1b& photograph, const Board& board) {
  cv::Mat1f smooth;
  photograph.convertTo(smooth, CV_32F);
  constexpr double kSmoothing = 1.2;  // [px]
  cv::GaussianBlur(smooth, smooth, {}, kSmoothing);
  // Other saddles, in the ground and on the diver, may have more contrast than the board.
  const auto most = static_cast<std::size_t>(2000 + 2 * board.columns * board.rows);
  const std::vector<Saddle> saddles = find_saddles(smooth, most);
  Grid grid;
  for (const LatticeCorner& corner : largest_lattice(smooth, saddles))
    grid.push_back({corner.cell, saddles[corner.saddle].pixel});
  return grid;
}

// Half the side of the window of a corner: it reaches no other corner and stays in the photograph.
// 0 if there is no space for a window.
int window_at(const cv::Mat1b& photograph, const Grid& grid, std::size_t i) {
  double spacing = std::numeric_limits<double>::infinity();
  for (std::size_t j = 0; j < grid.size(); ++j)
    if (j != i) spacing = std::min(spacing, (grid[j].pixel - grid[i].pixel).norm());
  int half = window_for(spacing);
  // One pixel more, because the corner will move.
  while (half > 1 && !holds_window(photograph, half + 1, grid[i].pixel)) --half;
  return half > 1 ? half : 0;
}

// Moves the corners to the intersections of edges, and leaves out corners without a window.
Grid refined(const cv::Mat1b& photograph, const Grid& grid) {
  Grid result;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const int half = window_at(photograph, grid, i);
    if (half == 0) continue;
    std::vector<cv::Point2f> corner{
        {static_cast<float>(grid[i].pixel.x()), static_cast<float>(grid[i].pixel.y())}};
    move_to_edges(photograph, half, corner);
    result.push_back({grid[i].cell, {corner[0].x, corner[0].y}});
  }
  return result;
}

Grid without_hidden(const cv::Mat1b& photograph, const Grid& grid) {
  constexpr double kClear = 0.05;  // more than perspective and little noise cause
  std::vector<double> asymmetries;
  for (std::size_t i = 0; i < grid.size(); ++i)
    asymmetries.push_back(
        asymmetry(photograph, std::max(2, window_at(photograph, grid, i)), grid[i].pixel));
  const double most = hidden_above(asymmetries, kClear);
  Grid clear;
  for (std::size_t i = 0; i < grid.size(); ++i)
    if (asymmetries[i] <= most) clear.push_back(grid[i]);
  return clear;
}

// The largest grid that a level of the pyramid shows, with exact corners. Finer levels show corners
// more exactly, if blur and noise do not hide them there. So a coarser level must show over a
// sixteenth more corners.
Grid largest_grid(const cv::Mat1b& photograph, const Board& board) {
  const std::vector<cv::Mat1b> levels = pyramid(photograph);
  Grid largest;
  std::size_t its_level = 0;
  for (std::size_t level = 0; level < levels.size(); ++level)
    if (Grid grid = grid_in(levels[level], board);
        grid.size() > largest.size() + largest.size() / 16)
      largest = std::move(grid), its_level = level;
  largest = refined(levels[its_level], largest);
  if (largest.empty()) return {};
  largest = without_hidden(levels[its_level], largest);
  // Pixel k of a level of cv::pyrDown() lies at pixel 2k of the finer level.
  for (GridCorner& corner : largest) corner.pixel *= static_cast<double>(1 << its_level);
  return largest;
}

Eigen::Vector2i least_cell(const Grid& grid) {
  Eigen::Vector2i least = grid.front().cell;
  for (const GridCorner& corner : grid) least = least.cwiseMin(corner.cell);
  return least;
}

Eigen::Vector2i extent(const Grid& grid) {
  if (grid.empty()) return {0, 0};
  Eigen::Vector2i most = grid.front().cell;
  for (const GridCorner& corner : grid) most = most.cwiseMax(corner.cell);
  return most - least_cell(grid) + Eigen::Vector2i(1, 1);
}

Grid within(const Grid& grid, const Eigen::Vector2i& first, const Eigen::Vector2i& size) {
  Grid part;
  for (const GridCorner& corner : grid) {
    const Eigen::Vector2i cell = corner.cell - first;
    if ((cell.array() >= 0).all() && (cell.array() < size.array()).all())
      part.push_back({cell, corner.pixel});
  }
  return part;
}

// The part of the grid that has the most corners of all parts that are not larger than the board.
// Something beside the board may look like one more row.
Grid on_board(const Grid& grid, const Board& board) {
  if (grid.empty()) return {};
  const Eigen::Vector2i size(board.columns, board.rows), first = least_cell(grid);
  const Eigen::Vector2i more = (extent(grid) - size).cwiseMax(0);
  Grid best;
  for (int y = 0; y <= more.y(); ++y)
    for (int x = 0; x <= more.x(); ++x)
      if (Grid part = within(grid, first + Eigen::Vector2i(x, y), size); part.size() > best.size())
        best = std::move(part);
  return best;
}

Grid quarter_turned(const Grid& grid) {
  Grid turned;
  for (const GridCorner& corner : grid)
    turned.push_back({{-corner.cell.y(), corner.cell.x()}, corner.pixel});
  return turned;
}

std::vector<Corner> numbered(const Grid& grid, const Board& board) {
  std::vector<Corner> corners;
  for (const GridCorner& corner : grid)
    corners.push_back({static_cast<std::size_t>(corner.cell.y() * board.columns + corner.cell.x()),
                       corner.pixel});
  std::ranges::sort(corners, {}, &Corner::number);
  return corners;
}

Piece piece_of(const Grid& grid, const Board& board) {
  const Grid straight = on_board(grid, board), turned = on_board(quarter_turned(grid), board);
  const bool turn = turned.size() > straight.size();
  const Eigen::Vector2i size = extent(turn ? turned : straight);
  Piece piece{size.x(), size.y(), numbered(turn ? turned : straight, board), {}};
  if (has_two_pitches(board) && turned.size() == straight.size())
    piece.turned = numbered(turned, board);
  return piece;
}

}  // namespace

bool Piece::suffices() const {
  constexpr std::size_t kLeastCorners = 12;
  constexpr int kLeastSide = 3;
  return corners.size() >= kLeastCorners && std::min(columns, rows) >= kLeastSide;
}

Piece find_piece(const cv::Mat1b& photograph, const Board& board) {
  return piece_of(largest_grid(photograph, board), board);
}

std::vector<Corner> turned_board(const Board& board, const std::vector<Corner>& corners) {
  Grid grid;
  for (const Corner& corner : corners) {
    const int number = static_cast<int>(corner.number);
    grid.push_back({{number % board.columns, number / board.columns}, corner.pixel});
  }
  return piece_of(grid, board).turned;
}

}  // namespace axial::calibrate
