// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/calibrate: the exact places of a checkerboard's corners in a photograph.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

namespace axial::calibrate {

// Half the side [px] of a window around a corner that does not reach another corner. `spacing`: the
// distance [px] to the nearest other corner.
int window_for(double spacing);

// True if the window of 2 half + 1 pixels around a corner lies in the photograph.
bool holds_window(const cv::Mat1b& photograph, int half, const Eigen::Vector2d& corner);

// Moves each corner to the intersection of the edges in the window of 2 half + 1 pixels around it.
void move_to_edges(const cv::Mat1b& photograph, int half, std::vector<cv::Point2f>& corners);

// The difference between the surroundings of a corner and the same surroundings after half a turn,
// divided by their contrast: near 0 at a corner of a checkerboard, which looks the same after half
// a turn. A hand, glare or dirt in the window increases the result, up to about 1. The window has
// 2 half + 1 pixels.
double asymmetry(const cv::Mat1b& photograph, int half, const Eigen::Vector2d& corner);

// The limit for the asymmetries of the corners of one board: what is above has hidden surroundings.
// It is three times the median, which noise increases, and at least `least`. Precondition: there
// are asymmetries.
double hidden_above(std::span<const double> asymmetries, double least);

}  // namespace axial::calibrate
