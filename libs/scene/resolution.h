// SPDX-License-Identifier: GPL-3.0-or-later
// The resolution that images are worked on at.
#pragma once

#include <opencv2/core.hpp>

#include "scene/camera_model.h"

namespace axial {

struct ResolutionOptions {
  unsigned level = 1;  // halvings of the image
  int min = 640;       // the longest side is not halved below this [px]
  int max = 2560;      // cap on the longest side [px]
};

// Size at which an image of width x height is worked on (OPENMVS_FACTS 6.0): aspect kept, sides
// rounded, at least 1. Error if a side or `max` is not positive.
cv::Size working_size(int width, int height, const ResolutionOptions& options);

// True if one is the other resized, aspect kept and sides rounded: one pixel of rounding on the
// shorter side, at the smaller of the two resolutions.
bool same_shape(cv::Size a, cv::Size b);

// `image` at `size`: area filter for shrinking, cubic for enlarging; a shared copy if it has that
// size already. CameraModel::resized is the matching camera. Error for empty images or sizes.
cv::Mat3b resized_image(const cv::Mat3b& image, cv::Size size);

// Label images must not be filtered: nearest neighbour.
cv::Mat1w resized_labels(const cv::Mat1w& labels, cv::Size size);

}  // namespace axial
