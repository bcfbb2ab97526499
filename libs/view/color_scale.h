// SPDX-License-Identifier: GPL-3.0-or-later
// Colours of values, for the pictures of maps and of depth maps.
#pragma once

#include <opencv2/core.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace axial::view {

// The colours (R G B) from the value `low` to the value `high`, at equal distances. Between two
// colours they are interpolated linearly. Values beyond the ends have the colours of the ends.
struct ColorScale {
  std::vector<cv::Vec3b> colors;  // at least one
  double low = 0, high = 1;
};

// Scales whose colours differ in brightness along the whole scale.
std::span<const cv::Vec3b> violet_to_yellow();  // for heights and distances
std::span<const cv::Vec3b> dark_to_green();     // for numbers
std::span<const cv::Vec3b> dark_to_light();     // for errors
// From orange (negative) over grey to blue (positive), as in the picture of CompareSurveys.
std::span<const cv::Vec3b> orange_to_blue();

ColorScale scale_of(std::span<const cv::Vec3b> colors, double low, double high);

// The colour (R G B) of a value. Precondition: the value is not NaN.
cv::Vec3b color_of(const ColorScale& scale, double value);

// "#rrggbb" of a colour R G B.
std::string css_color(const cv::Vec3b& color);

// The values that the shares `low` and `high` of all values do not exceed. NaN does not count. {0,
// 0} without values. The second value is at least the first one.
std::pair<double, double> quantiles(const cv::Mat1f& values, double low, double high);

// The picture (B G R) of `values`. `shades`: empty, or for each pixel the brightness (0 to 255) by
// which its colour is multiplied. NaN gets the colour kNothing.
cv::Mat3b painted(const cv::Mat1f& values, const ColorScale& scale, const cv::Mat1b& shades = {});

// The ground of the page, R G B: the colour of places without a value.
inline const cv::Vec3b kNothing{23, 26, 30};

}  // namespace axial::view
