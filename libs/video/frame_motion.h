// SPDX-License-Identifier: GPL-3.0-or-later
// Measures sharpness and motion of the frames of a video.
#pragma once

#include <opencv2/core.hpp>

#include "video/choose_frames.h"

namespace axial::video {

// Measures frames in sequence.
class FrameMeter {
 public:
  // Measures the next frame of the clip. `frame`: B G R. The sharpness is the variance of the
  // Laplacian of a grey copy whose longer side has at most 960 pixels. The motion is fitted to
  // corners that are tracked from the frame before; it is absent if fewer than 12 corners, or fewer
  // than 40 %, agree.
  FrameMeasure measure(const cv::Mat3b& frame);

 private:
  cv::Mat1b before_;
};

}  // namespace axial::video
