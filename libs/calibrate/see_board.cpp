// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibrate/see_board.h"

#include <fmt/format.h>

#include <utility>

#include "calibrate/piece.h"
#include "calibrate/whole_board.h"
#include "targets/codes/marker_board.h"

namespace axial::calibrate {
namespace {

std::string fault_of(const Piece& piece) {
  if (piece.corners.empty()) return "no checkerboard is found";
  return fmt::format(
      "{} corners of the checkerboard are found, in {} columns and {} rows; "
      "the least piece has 3 x 4 corners",
      piece.corners.size(), piece.columns, piece.rows);
}

// True if the photograph shows so many corners, and only so many, that the others must be hidden.
bool hidden_in_part(const Piece& piece, const Board& board) {
  constexpr double kNearlyAll = 0.9;
  return piece.suffices() &&
         static_cast<double>(piece.corners.size()) < kNearlyAll * board.columns * board.rows;
}

View see_markers(const std::string& name, const cv::Mat1b& photograph, const Board& board) {
  View view{name, targets::find_marker_corners(photograph, board)};
  if (view.corners.empty()) view.fault = "no marker of the board is found";
  return view;
}

View whole(const std::string& name, std::vector<Corner> corners, const Board& board) {
  std::vector<Corner> turned = turned_board(board, corners);
  return {name, std::move(corners), false, std::move(turned)};
}

}  // namespace

View see_board(const std::string& name, const cv::Mat1b& photograph, const Board& board) {
  if (board.kind != BoardKind::checkerboard) return see_markers(name, photograph, board);
  if (auto corners = find_whole_board(photograph, board); !corners.empty())
    return whole(name, std::move(corners), board);
  Piece piece = find_piece(photograph, board);
  if (!hidden_in_part(piece, board))
    if (auto corners = find_board_without_margin(photograph, board); !corners.empty())
      return whole(name, std::move(corners), board);
  if (!piece.suffices()) return {name, {}, false, {}, fault_of(piece)};
  return {name, std::move(piece.corners), true, std::move(piece.turned)};
}

}  // namespace axial::calibrate
