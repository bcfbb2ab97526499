// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a calibration's photographs suffice, and if not, what to photograph.
#pragma once

#include <array>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "calibrate/calibrate.h"
#include "calibrate/placed_board.h"

namespace axial::calibrate {

// The largest standard deviations that will do, of the numbers in housing_change.h.
struct Limits {
  double normal = 0.1 * std::numbers::pi / 180;  // [rad]
  double place = 0.001;                          // a flat port's distance, a dome's centre [m]
  double index = 0.005;
  double thickness = 0.002;  // [m]
};

// What no photograph shows, in words: corners near each edge of the image, a tilted board, boards
// near and far. Empty for a good set.
std::vector<std::string> gaps(const Calibration& calibration);

// The photograph that would help most: of placed_boards() no nearer than four fifths of the
// nearest photograph, since nearer ones may be out of focus, the one that leaves the largest
// standard deviation, by its limit, smallest.
struct NextPhotograph {
  PlacedBoard board;
  pose::HousingChange<double> sigmas;  // with it
};
std::optional<NextPhotograph> next_photograph(const Calibration& calibration, const Limits& limits);

// Error if some number is known worse than its limit: which one, how well, what is missing, and
// what to photograph next.
void require_known(const Calibration& calibration, const Limits& limits);

// Where a view's board is.
struct BoardPlace {
  double distance = 0;      // of its middle from the camera [m]
  double tilt_degrees = 0;  // of its plane, to the image plane
};
BoardPlace board_place(const pose::Bundle& bundle, std::size_t image);

}  // namespace axial::calibrate
