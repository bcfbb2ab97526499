// SPDX-License-Identifier: GPL-3.0-or-later
// Decides whether the photographs of a calibration are sufficient, and otherwise which photograph
// to add.
#pragma once

#include <array>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "calibrate/calibrate.h"
#include "calibrate/placed_board.h"

namespace axial::calibrate {

// The largest acceptable standard deviations of the numbers in housing_change.h.
struct Limits {
  double normal = 0.1 * std::numbers::pi / 180;  // [rad]
  double place = 0.001;                          // a flat port's distance, a dome's centre [m]
  double index = 0.005;
  double thickness = 0.002;  // [m]
};

// Returns the gaps of the photographs as texts. Each text continues the sentence "no photograph
// shows". A gap is one of three: no corners near an edge of the image, no tilted board, or no
// second distance. Empty if there is no gap.
std::vector<std::string> gaps(const Calibration& calibration);

struct NextPhotograph {
  PlacedBoard board;
  pose::HousingChange<double> sigmas;  // standard deviations with this photograph added
};

// Returns the most useful next photograph. The candidates are placed_boards() (placed_board.h). Let
// the ratio of a number be its standard deviation with the candidate added, divided by the limit of
// the number. The result is the candidate with the smallest largest ratio. No candidate is closer
// than 0.8 times the distance of the nearest board in the photographs, because a closer board may
// be out of focus. Empty if no candidate fits into the image, or if no candidate gives a finite
// largest ratio.
std::optional<NextPhotograph> next_photograph(const Calibration& calibration, const Limits& limits);

// Throws an Error if a number has a standard deviation above its limit. The message names the
// number with the largest ratio of standard deviation and limit, its standard deviation, the gaps
// of the photographs, and the next photograph to take.
void require_known(const Calibration& calibration, const Limits& limits);

// The place of the board in one image of a bundle.
struct BoardPlace {
  double distance = 0;      // from the camera to the board's middle [m]
  double tilt_degrees = 0;  // angle between the board and the image plane
};
BoardPlace board_place(const pose::Bundle& bundle, std::size_t image);

}  // namespace axial::calibrate
