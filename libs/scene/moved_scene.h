// SPDX-License-Identifier: GPL-3.0-or-later
// Moves a scene by a similarity.
#pragma once

#include "scene/decompositions.h"
#include "scene/local_frame.h"
#include "scene/scene.h"

namespace axial {

// A similarity between local frames: `similarity` maps coordinates in `from` to coordinates in
// `to`. Far from the origin of the world, no large numbers take part in it.
struct FrameMove {
  Similarity similarity;
  LocalFrame from, to;

  // The same map with the result in another frame.
  FrameMove ending_in(const LocalFrame& frame) const;
  // The map from world to world coordinates.
  Similarity between_worlds() const;
};

// `worlds` maps world to world coordinates. The result starts and ends in `frame`.
FrameMove move_in(const LocalFrame& frame, const Similarity& worlds);

// Moves poses, points, normals, depth ranges and the region of interest. `scene` is in the frame
// that `similarity` starts from. The cameras' ports stay as they are.
void apply(const Similarity& similarity, Scene& scene);

}  // namespace axial
