// SPDX-License-Identifier: GPL-3.0-or-later
// OpenCV's sets of square markers.
#pragma once

#include <opencv2/aruco/dictionary.hpp>
#include <optional>
#include <string>

namespace axial::targets {

// Returns OpenCV's number of the dictionary `name`: "4X4_50" to "7X7_1000", "ARUCO_ORIGINAL",
// "APRILTAG_16h5", "APRILTAG_25h9", "APRILTAG_36h10" or "APRILTAG_36h11". Nothing for another name.
std::optional<int> dictionary_number(const std::string& name);

// Returns the dictionary with OpenCV's number `number`. It must be a result of dictionary_number().
cv::Ptr<cv::aruco::Dictionary> dictionary(int number);

}  // namespace axial::targets
