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

// The largest acceptable standard deviations of the free numbers of a camera
// (pose/bundle/housing_change.h). The focal length has no limit.
struct Limits {
  double normal = 0.1 * std::numbers::pi / 180;  // tilts of a flat port's normal [rad]
  double place = 0.001;      // a flat port's distance; a coordinate of a dome's centre [m]
  double index = 0.005;      // refractive index of the water
  double thickness = 0.002;  // of the glass [m]
};

// Returns the gaps of the photographs as texts that continue the sentence "no photograph shows".
// Empty if there is no gap. Three kinds of gaps are found, in this order:
// - All corners are farther from an edge of the image than 15 % of its width (left, right) or
//   height (upper, lower). Each such edge is a gap.
// - No board is tilted by 20 degrees or more (BoardPlace).
// - The farthest board is less than 1.3 times as far away as the nearest one.
// Corners that calibrate() dropped do not count.
std::vector<std::string> gaps(const Calibration& calibration);

// A photograph to take, and what it would achieve.
struct NextPhotograph {
  PlacedBoard board;
  // The expected standard deviations of the numbers of the camera, with this photograph added, in
  // the units of pose/bundle/housing_change.h. 0 for a number that is not free.
  pose::HousingChange<double> sigmas;
};

// Returns the most useful next photograph. The candidates are placed_boards() (placed_board.h). Let
// the ratio of a free number be its standard deviation with the candidate added, divided by the
// limit of the number. The result is the candidate whose largest ratio is the smallest. The noise
// of corners is the observed one, but at least 0.1 px. No candidate is closer than 0.8 times the
// distance of the nearest board in the photographs, because a closer board may be out of focus.
// Empty if no candidate fits into the image, or if no candidate gives a finite largest ratio.
std::optional<NextPhotograph> next_photograph(const Calibration& calibration, const Limits& limits);

// Throws an Error if a free number has a standard deviation above its limit. The message names the
// number with the largest ratio of standard deviation and limit, its standard deviation and its
// limit, the gaps of the photographs, and the next photograph to take.
void require_known(const Calibration& calibration, const Limits& limits);

// The place of the board, or of the visible piece of the board, relative to the camera in one
// image.
struct BoardPlace {
  double distance = 0;      // from the camera's centre to the mean of its corners [m]
  double tilt_degrees = 0;  // angle between the board and the image plane, from 0 to 90
};
// Returns the place of the board in the image with the index `image` in bundle.images. `bundle`: a
// bundle of board_bundle() (board_bundle.h) with known poses. `view`: the view of the image.
BoardPlace board_place(const pose::Bundle& bundle, std::size_t image, const View& view);

}  // namespace axial::calibrate
