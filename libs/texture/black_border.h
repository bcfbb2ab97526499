// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the black borders that undistortion leaves.
#pragma once

#include <opencv2/core.hpp>

namespace axial::texture {

// Returns 0 at the pixels of black borders and 255 elsewhere; nothing (an empty image) if there are
// none. A black border consists of pixels whose channels are all at most `darkest`, connected to
// the image's edge through such pixels, and of all pixels nearer to them than `margin`, because
// resampling and compression mix colours there.
cv::Mat1b outside_black_border(const cv::Mat3b& image, int darkest = 4, int margin = 3);

}  // namespace axial::texture
