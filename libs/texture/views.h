// SPDX-License-Identifier: GPL-3.0-or-later
// The photographs that give a mesh its colours.
#pragma once

#include <cstddef>
#include <functional>
#include <opencv2/core.hpp>

#include "geometry/posed_camera.h"

namespace axial::texture {

using View = geometry::PosedCamera;  // of a photograph, in the frame of the mesh

// The pixels of a photograph.
struct ViewImage {
  cv::Mat3b color;   // B G R, of the size of the view's camera
  cv::Mat1b usable;  // size of `color`; 0: the pixel must not be used. Empty: all may be used
};

// Returns the photograph of view `index`. The function is called concurrently, may be called more
// than once for each view, and must return the same image each time. The number of images in memory
// at the same time is at most the number of threads.
using ImageSource = std::function<ViewImage(std::size_t index)>;

}  // namespace axial::texture
