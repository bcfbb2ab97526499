// SPDX-License-Identifier: GPL-3.0-or-later
// The resolution at which images are processed.
#pragma once

#include <opencv2/core.hpp>

#include "axial/scene_options.h"

namespace axial {

// The size [px] at which an image of width x height pixels is processed. The longest side is halved
// up to `level` times (rounded down), as long as the result is at least `min`. A smaller image is
// not enlarged. A result above `max` is then reduced to `max`. The aspect ratio is kept: sides are
// rounded and at least 1. Throws an Error if a side or `max` is not positive.
cv::Size working_size(int width, int height, const ResolutionOptions& options);

// True if two sizes have the same aspect ratio, up to the rounding of sides to whole pixels. Let s
// be the shortest of the four sides. The quotient of the two aspect ratios may differ from 1 by at
// most 1.5 / s. False if s is below 1.
bool same_shape(cv::Size a, cv::Size b);

// Resizes `image` to `size`, with an area filter if no side grows and a cubic filter otherwise. If
// the image already has this size, the result shares its pixels. CameraModel::resized() gives the
// camera of the result. Throws an Error for an empty image or size.
cv::Mat3b resized_image(const cv::Mat3b& image, cv::Size size);

// Resizes an image of labels to `size`. Each pixel of the result has the label of the nearest
// pixel, because labels must not be averaged. If `labels` already has this size, the result shares
// its pixels. Throws an Error for an empty image or size.
cv::Mat1w resized_labels(const cv::Mat1w& labels, cv::Size size);

}  // namespace axial
