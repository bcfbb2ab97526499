// SPDX-License-Identifier: GPL-3.0-or-later
// Families of coded targets.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "targets/codes/board.h"

namespace axial::targets {

// ring: a white dot in a ring of segments on black (ring_codes.h). square: an ArUco or AprilTag
// marker of OpenCV. board: the inner corners of a ChArUco board.
enum class Kind { ring, square, board };

struct Family {
  std::string name{};  // as parse_families() reads it
  Kind kind = Kind::ring;
  int bits = 0;        // ring: the segments of the ring
  int dictionary = 0;  // square: OpenCV's number (dictionary.h)
  Board board{};       // board
  // Labels by number, in place of "target 7" (target_table.h). Empty: none are given.
  std::map<std::size_t, std::string> labels{};
};

// The families of programs that find targets, without --families.
inline constexpr const char* kUsualFamilies = "circular12,APRILTAG_36h11";

// Reads the name of a family: "circular12", "circular14", "circular16", "circular20", or a
// dictionary of dictionary_number() (dictionary.h). Throws an Error that contains `text` for
// another name.
Family parse_family(const std::string& text);

// Reads names of families, separated by commas; a board as parse_board() reads it
// ("charuco:7x5:0.04:0.03"). Throws an Error for no name, for a name that parse_family() or
// parse_board() refuses, and for two families of one kind, because their labels would be equal.
std::vector<Family> parse_families(const std::string& text);

// The numbers of the family's targets: first, first + 1, ..., last. Rings are counted from 1,
// markers from 0, and the corners of a board from 0 as in corners_of() (board.h).
struct Numbers {
  std::size_t first = 0, last = 0;
};
Numbers numbers_of(const Family& family);

// What the target shows: the code of a ring (ring_codes.h); the number of a marker or of a corner.
// Precondition: the number is one of numbers_of().
std::size_t code_of(const Family& family, std::size_t number);

// Returns the label of a target: "target 7" for a ring, "tag 7" for a marker, "board corner 7" for
// a corner. If the family has labels: its label, or "code 119" for a target without one.
std::string label_of(const Family& family, std::size_t number);

}  // namespace axial::targets
