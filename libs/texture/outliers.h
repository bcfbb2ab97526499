// SPDX-License-Identifier: GPL-3.0-or-later
// Removes views that show something else than the other views of a face: a fish, a hand, a
// reflection.
#pragma once

#include <cstddef>

#include "texture/face_views.h"

namespace axial::texture {

// For each face that at least five views see, removes the sights whose colour is far from the
// median of all: exp(-d^2 / 2) < threshold, where d^2 is the sum over the channels of the squared
// difference, in units of the channel's robust standard deviation (1.4826 times the median absolute
// deviation, at least 6 grey levels: noise, and points on the surface that are not exactly the
// same). If all sights of a face are far from the median, all of them stay. Returns the
// number of removed sights. threshold 0: nothing is removed.
std::size_t remove_outliers(FaceViews& views, double threshold);

}  // namespace axial::texture
