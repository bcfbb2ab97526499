// SPDX-License-Identifier: GPL-3.0-or-later
// Colour charts of 24 patches (6 x 4, from dark skin to black) in photographs.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace axial::color {

// The patches, row by row. The last row is grey, from white to black.
inline constexpr std::size_t kPatches = 24;

// The colours of the patches of a ColorChecker Classic, as its maker published them in sRGB before
// November 2014, in linear light. Cyan lies outside sRGB and is cut off.
std::array<Eigen::Array3f, kPatches> chart_colors();

// Where a chart is in a photograph: its corners beside dark skin, bluish green, black and white
// [px], without the frame.
struct Chart {
  std::array<cv::Point2f, 4> corners;
};

// The charts in a photograph, at most 4: B G R of 8 bits with the curve of sRGB, not empty. Its
// colours must be about right, as they are after the water was taken away. A chart must be longer
// than about 170 pixels, and than a tenth of the photograph's longer side. Corners may lie outside
// the photograph. Other pictures of 24 patches may be among the charts: see likeness().
std::vector<Chart> find_charts(const cv::Mat3b& pixels);

// The memory [bytes] of find_charts() for a photograph of this size, without the photograph.
std::uint64_t bytes_to_find_charts(cv::Size size);

// The pixels of the middle of a patch, from 0 to 23, in an image of this size. Empty if the patch
// lies outside.
std::vector<cv::Point> pixels_of_patch(const Chart& chart, std::size_t patch, cv::Size size);

// The restored light of the patches of a chart; NaN where it is not known.
using PatchLights = std::array<Eigen::Array3f, kPatches>;

// How much the patches have the contrasts of a chart: the smallest correlation of light and
// published colour among the channels with known[channel], of patches whose light is known. At most
// 1. Random colours exceed kLeastLikeness once in a million. 0 with fewer than 12 patches in one of
// these channels, and without such a channel.
double likeness(const PatchLights& lights, const std::array<bool, 3>& known);
inline constexpr double kLeastLikeness = 0.8;

// The factors of R, G and B by which the five brightest grey patches have their published colours:
// the median of the patches. NaN in a channel in which fewer than three of them have a light that
// is known and above 0.
Eigen::Array3f gain_of(const PatchLights& lights);

// The median CIEDE2000 between published colours and `lights` times `gain`, of known patches. NaN
// if fewer than 12 are known, or if `gain` is NaN.
double chart_error(const PatchLights& lights, const Eigen::Array3f& gain);

}  // namespace axial::color
