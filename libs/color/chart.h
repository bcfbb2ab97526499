// SPDX-License-Identifier: GPL-3.0-or-later
// Colour charts of 24 patches (6 x 4, from dark skin to black) in photographs.
#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>
#include <vector>

namespace axial::color {

inline constexpr std::size_t kPatches =
    24;  // row by row; the last row is grey, from white to black

// The colours of the patches, linear sRGB for the white of D65: the published values.
std::array<Eigen::Array3f, kPatches> chart_colors();

// Where a chart is in a photograph: its corners beside dark skin, bluish green, black and white
// [px], without the frame.
struct Chart {
  std::array<cv::Point2f, 4> corners;
};

// The charts in a photograph, `pixels` in B G R of 8 bits. Colours must be about right, as they are
// after the water was taken away. A chart must be longer than about 170 pixels, and than a tenth of
// the photograph's longer side.
std::vector<Chart> find_charts(const cv::Mat& pixels);

// The pixels of the middle of a patch, which lie in an image of this size.
std::vector<cv::Point> pixels_of_patch(const Chart& chart, std::size_t patch, cv::Size size);

// The restored light of the patches of a chart; NaN where it is not known.
using PatchLights = std::array<Eigen::Array3f, kPatches>;

// The factors of R, G and B by which the five brightest grey patches have their published colours:
// the median of the patches. NaN if fewer than three of them are known and above 0 in a channel.
Eigen::Array3f gain_of(const PatchLights& lights);

// The median CIEDE2000 between published colours and `lights` times `gain`, of known patches. NaN
// if fewer than 12 are known.
double chart_error(const PatchLights& lights, const Eigen::Array3f& gain);

}  // namespace axial::color
