// SPDX-License-Identifier: GPL-3.0-or-later
// The views that see each face of a mesh, and how well.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/progress.h"
#include "scene/mesh.h"
#include "texture/views.h"

namespace axial::texture {

// A view that sees a face.
struct Sight {
  std::uint32_t view = 0;
  float quality = 0;                    // higher is better
  std::array<std::uint8_t, 3> color{};  // mean colour of the face in this view, B G R
  bool whole = true;                    // all of the face is seen
};

// The sights of all faces in one array; those of face f are at [begin[f], begin[f + 1]), in the
// order of the views.
struct FaceViews {
  std::vector<std::uint64_t> begin;
  std::vector<Sight> sights;

  std::size_t faces() const { return begin.size() - 1; }
  std::span<const Sight> of(std::size_t face) const {
    return std::span(sights).subspan(begin[face], begin[face + 1] - begin[face]);
  }
};

struct VisibilityOptions {
  // A face that is in front of another by less than this share of the distance to the camera does
  // not hide it. About the width of a pixel.
  double tolerance = 1e-3;
};

// Finds for each face the views that see all of it:
//   - The face is turned towards the camera, and its corners are inside the image. Corners are
//     projected by the exact camera.
//   - No pixel on it is unusable (ViewImage::usable).
//   - No other face lies on the path of light from its corners, and from points on a grid inside
//     larger faces, to the point where the light leaves the water (exit_point of the camera).
// A face that no view sees in this way gets the views that see its middle, if there are any: other
// faces may hide its corners, and it may be turned away if its neighbours are not.
// The quality is its area in the image [px] times max(0.001, cos)^2, with the angle between the
// path of light and the normal, which is smoothed over the neighbouring faces.
// Error for a mesh that Occluders refuses, and an Error of `images`.
FaceViews find_face_views(const Mesh& mesh, std::span<const View> views, const ImageSource& images,
                          const VisibilityOptions& options = {}, const ProgressSink& progress = {});

}  // namespace axial::texture
