// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/codes/dictionary.h"

#include <array>
#include <string_view>
#include <utility>

namespace axial::targets {
namespace {

constexpr std::array<std::pair<std::string_view, int>, 21> kDictionaries{
    {{"4X4_50", cv::aruco::DICT_4X4_50},
     {"4X4_100", cv::aruco::DICT_4X4_100},
     {"4X4_250", cv::aruco::DICT_4X4_250},
     {"4X4_1000", cv::aruco::DICT_4X4_1000},
     {"5X5_50", cv::aruco::DICT_5X5_50},
     {"5X5_100", cv::aruco::DICT_5X5_100},
     {"5X5_250", cv::aruco::DICT_5X5_250},
     {"5X5_1000", cv::aruco::DICT_5X5_1000},
     {"6X6_50", cv::aruco::DICT_6X6_50},
     {"6X6_100", cv::aruco::DICT_6X6_100},
     {"6X6_250", cv::aruco::DICT_6X6_250},
     {"6X6_1000", cv::aruco::DICT_6X6_1000},
     {"7X7_50", cv::aruco::DICT_7X7_50},
     {"7X7_100", cv::aruco::DICT_7X7_100},
     {"7X7_250", cv::aruco::DICT_7X7_250},
     {"7X7_1000", cv::aruco::DICT_7X7_1000},
     {"ARUCO_ORIGINAL", cv::aruco::DICT_ARUCO_ORIGINAL},
     {"APRILTAG_16h5", cv::aruco::DICT_APRILTAG_16h5},
     {"APRILTAG_25h9", cv::aruco::DICT_APRILTAG_25h9},
     {"APRILTAG_36h10", cv::aruco::DICT_APRILTAG_36h10},
     {"APRILTAG_36h11", cv::aruco::DICT_APRILTAG_36h11}}};

}  // namespace

std::optional<int> dictionary_number(const std::string& name) {
  for (const auto& [known, number] : kDictionaries)
    if (known == name) return number;
  return std::nullopt;
}

cv::Ptr<cv::aruco::Dictionary> dictionary(int number) {
  return cv::aruco::getPredefinedDictionary(number);
}

}  // namespace axial::targets
