// SPDX-License-Identifier: GPL-3.0-or-later
// How the contents of a picture move from one frame of a video to another.
#pragma once

#include <complex>

namespace axial::video {

// A similarity between two frames. The point z of the first frame is at turn * z + shift in the
// second frame. Points are complex numbers (right, down), measured from the centre of the picture
// in widths of the picture.
struct Motion {
  std::complex<double> turn = 1, shift = 0;
};

// The motion `first` followed by the motion `second`.
Motion then(const Motion& first, const Motion& second);

// The root mean square of the displacements of all points of the picture, in widths of the picture.
// `aspect`: height of the picture divided by its width.
double displacement(const Motion& motion, double aspect);

}  // namespace axial::video
