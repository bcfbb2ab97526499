// SPDX-License-Identifier: GPL-3.0-or-later
// Moves a scene by a similarity.
#pragma once

#include "scene/decompositions.h"
#include "scene/local_frame.h"
#include "scene/scene.h"

namespace axial {

// A similarity between local frames (local_frame.h): `similarity` maps coordinates in `from` to
// coordinates in `to`. The numbers of `similarity` stay small even if the scene is far from the
// origin of the world.
struct FrameMove {
  Similarity similarity;
  LocalFrame from, to;

  // This map, with results in coordinates of `frame` instead of `to`.
  FrameMove ending_in(const LocalFrame& frame) const;
  // This map, from world coordinates to world coordinates.
  Similarity between_worlds() const;
};

// Returns the map `worlds`, which maps world coordinates to world coordinates, in local
// coordinates: `from` and `to` of the result are `frame`.
FrameMove move_in(const LocalFrame& frame, const Similarity& worlds);

// Moves `scene` in place by `similarity`: the poses and depth ranges of the calibrated images, the
// sparse points, their normals and the region of interest. Before the call `scene` is in the frame
// from which `similarity` maps, and after the call in the frame to which `similarity` maps. The
// cameras' ports stay as they are, even if the scale changes.
void apply(const Similarity& similarity, Scene& scene);

}  // namespace axial
