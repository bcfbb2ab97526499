// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the black borders that undistortion leaves.
#pragma once

#include <opencv2/core.hpp>

namespace axial::survey {

// Returns an image of the size of `image` that is 0 at the pixels of black borders and 255
// elsewhere. Returns an empty image if there is no black border. Precondition: `image` is not
// empty. A pixel is dark if all its channels are at most `darkest`. A black border consists of
//   - the dark pixels that are connected to the image's edge through dark pixels,
//   - the pixels that are at most `margin` pixels in x and at most `margin` pixels in y from one of
//     these dark pixels, because resampling and compression mix colours there.
cv::Mat1b outside_black_border(const cv::Mat3b& image, int darkest = 4, int margin = 3);

}  // namespace axial::survey
