// SPDX-License-Identifier: GPL-3.0-or-later
// Maps and depth maps in the form in which the page shows them.
#pragma once

#include <opencv2/core.hpp>
#include <string>

namespace axial::view {

// The picture (B G R) of an orthomosaic `colors` (R G B alpha). Transparent places show kNothing.
cv::Mat3b opaque(const cv::Mat4b& colors);

// The brightness of a relief under a light from the upper left, 45 degrees above the ground: 115 on
// the side turned away, 255 on the side turned to the light. `heights` has y downwards and pixels
// of `width` x `height` metres. Neighbours without height (NaN) get the height of the pixel.
cv::Mat1b relief(const cv::Mat1f& heights, double width, double height);

// The values reduced to `size` pixels. A reduced pixel is the mean of the values in its area that
// are not NaN, and NaN if less than half of its area has values. `size` has no more columns and
// rows than `values`.
cv::Mat1f reduced_values(const cv::Mat1f& values, cv::Size size);

// Heights in 16 bits, little-endian, row by row: 0 where the height is NaN, and otherwise 1 + the
// multiple of `step` above `low`.
struct HeightData {
  double low = 0, step = 0;  // [m]
  std::string bytes;
};
HeightData height_data(const cv::Mat1f& heights);

// The picture (B G R) of unit normals in the frame of a camera (x right, y down, z ahead), reduced
// to `size`. Red grows with x, green with -y, and blue with -z, the direction to the camera. Zero
// normals do not count; places where more than half of them are zero show kNothing.
cv::Mat3b normal_picture(const cv::Mat3f& normals, cv::Size size);

}  // namespace axial::view
