// SPDX-License-Identifier: GPL-3.0-or-later
// Families of coded targets.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace axial::targets {

// ring: a white dot in a ring of segments on black (ring_codes.h). square: an ArUco or AprilTag
// marker of OpenCV.
enum class Kind { ring, square };

struct Family {
  std::string name;  // as parse_family() reads it
  Kind kind = Kind::ring;
  int bits = 0;        // ring: the segments of the ring
  int dictionary = 0;  // square: OpenCV's number (dictionary.h)
};

// Reads the name of a family: "circular12", "circular14", "circular16", "circular20", or a
// dictionary of dictionary_number() (dictionary.h). Throws an Error that contains `text` for
// another name.
Family parse_family(const std::string& text);

// Reads names of families, separated by commas. Throws an Error for no name, for a name that
// parse_family() refuses, and for two families of one kind, because their labels would be equal.
std::vector<Family> parse_families(const std::string& text);

// The numbers of the family's targets: first, first + 1, ..., last. Rings are counted from 1,
// markers from 0.
struct Numbers {
  std::size_t first = 0, last = 0;
};
Numbers numbers_of(const Family& family);

// Returns the label of a target: "target 7" for a ring, "tag 7" for a marker.
std::string label_of(const Family& family, std::size_t number);

}  // namespace axial::targets
