// SPDX-License-Identifier: GPL-3.0-or-later
// Removes the views in which a face has another colour than in most views. Such a view shows, for
// example, a fish, a hand or a reflection.
#pragma once

#include <cstddef>

#include "texture/faces/face_views.h"

namespace axial::texture {

// Removes from each face of `views` the sights whose colour is far from the median colour of the
// face's sights.
//
// For each channel, let s be the robust standard deviation of the sights' colours: 1.4826 times the
// median absolute deviation. If s is below 6 grey levels, it is raised to 6, because of noise and
// because views do not show exactly the same points of the surface. Let d^2 be the sum over the
// channels of ((colour - median) / s)^2. A sight is far from the median if exp(-d^2 / 2) <
// threshold. Useful thresholds are below 1.
//
// All sights stay in these cases: fewer than five views see the face, no view sees all of the face
// (Sight::whole), all sights are far from the median, or threshold is 0 or less. Returns the number
// of removed sights.
std::size_t remove_outliers(FaceViews& views, double threshold);

}  // namespace axial::texture
