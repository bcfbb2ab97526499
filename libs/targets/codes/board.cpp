// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/codes/board.h"

#include <algorithm>
#include <array>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/parse_number.h"
#include "targets/codes/marker_board.h"

namespace axial::targets {
namespace {

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, at);) parts.push_back(part);
  return parts;
}

template <class T>
T number(const std::string& word, const std::string& text) {
  const std::optional<T> value = parse_number<T>(word);
  if (!value) fail("{}: '{}' is not a number", text, word);
  return *value;
}

double metres(const std::string& word, const std::string& text) {
  const auto length = number<double>(word, text);
  constexpr double kLargest = 10;
  if (!(length > 0 && length <= kLargest))
    fail("{}: '{}' is not a length in metres from 0 to {}", text, word, kLargest);
  return length;
}

void read_counts(const std::string& word, const std::string& text, Board& board) {
  const std::vector<std::string> counts = split(word, 'x');
  if (counts.size() != 2) fail("{}: '{}' is not COLUMNSxROWS", text, word);
  board.columns = number<int>(counts[0], text);
  board.rows = number<int>(counts[1], text);
  // OpenCV needs at least 3 columns and rows to find a checkerboard or make a ChArUco board.
  const int least = board.kind == BoardKind::apriltags ? 1 : 3;
  constexpr int kMost = 100;
  for (const int count : {board.columns, board.rows})
    if (count < least || count > kMost)
      fail("{}: {} columns and {} rows, expected {} to {} of each", text, board.columns, board.rows,
           least, kMost);
}

// SQUARE or WIDTH,HEIGHT of a checkerboard.
void read_square(const std::string& word, const std::string& text, Board& board) {
  const std::vector<std::string> sides = split(word, ',');
  if (sides.empty() || sides.size() > 2 || word.back() == ',')
    fail("{}: '{}' is neither SQUARE nor WIDTH,HEIGHT", text, word);
  board.size = metres(sides[0], text);
  const double height = metres(sides.back(), text);
  constexpr double kMostRatio = 1.5;
  if (std::max(height, board.size) > kMostRatio * std::min(height, board.size))
    fail("{}: squares of {} x {} m are not nearly square", text, board.size, height);
  if (height != board.size) board.second = height;
}

constexpr std::array<std::pair<std::string_view, BoardKind>, 3> kKinds{
    {{"checkerboard", BoardKind::checkerboard},
     {"charuco", BoardKind::charuco},
     {"apriltags", BoardKind::apriltags}}};

BoardKind kind_of(const std::string& word, const std::string& text) {
  for (const auto& [name, kind] : kKinds)
    if (name == word) return kind;
  fail("{}: must begin with checkerboard:, charuco: or apriltags:", text);
}

}  // namespace

Board parse_board(const std::string& text) {
  const std::vector<std::string> parts = split(text, ':');
  Board board;
  board.kind = kind_of(parts.empty() ? "" : parts[0], text);
  const bool markers = board.kind != BoardKind::checkerboard;
  const std::size_t least = markers ? 4 : 3, most = markers ? 5 : 3;
  if (parts.size() < least || parts.size() > most)
    fail(
        "{}: must be checkerboard:COLUMNSxROWS:SQUARE (or WIDTH,HEIGHT of a square), "
        "charuco:COLUMNSxROWS:SQUARE:MARKER or apriltags:COLUMNSxROWS:TAG:GAP, in metres",
        text);
  read_counts(parts[1], text, board);
  if (!markers) {
    read_square(parts[2], text, board);
    return board;
  }
  board.size = metres(parts[2], text);
  board.second = metres(parts[3], text);
  if (board.kind == BoardKind::charuco && board.second >= board.size)
    fail("{}: a marker of {} m does not fit into a square of {} m", text, board.second, board.size);
  const bool tags = board.kind == BoardKind::apriltags;
  board.dictionary = parts.size() > 4 ? parts[4] : tags ? "APRILTAG_36h11" : "4X4_50";
  check_markers(board, text);
  return board;
}

bool has_two_pitches(const Board& board) {
  return board.kind == BoardKind::checkerboard && board.second > 0;
}

std::vector<Eigen::Vector3d> corners_of(const Board& board) {
  if (board.kind != BoardKind::checkerboard) return marker_board_corners(board);
  const double height = has_two_pitches(board) ? board.second : board.size;
  std::vector<Eigen::Vector3d> corners;
  for (int row = 0; row < board.rows; ++row)
    for (int column = 0; column < board.columns; ++column)
      corners.emplace_back(column * board.size, row * height, 0);
  return corners;
}

}  // namespace axial::targets
