// SPDX-License-Identifier: GPL-3.0-or-later
// The scorer for cameras with distorted lenses. Each instruction set has a translation unit for
// this scorer. This translation unit is separate from the translation unit for undistorted
// lenses, so that the machine code for undistorted lenses does not depend on distorted lenses.
#pragma once

#include "depth/lanes/lane_scorer.h"
#include "refractive/lens_camera.h"

namespace axial::depth::lanes {

// Makes a scorer for the kind of camera in `tables`, which must outlive the scorer. Returns nullptr
// if this kind has no distorted lens. Narrow, Wide: see LaneScorer.
template <class Narrow, class Wide = Narrow>
std::unique_ptr<Scorer> make_lane_lens_scorer(const SceneTables& tables) {
  switch (tables.kind) {
    case CameraKind::lens_pinhole:
      return std::make_unique<LaneScorer<refractive::LensPinholeCamera, Narrow, Wide>>(tables);
    case CameraKind::lens_flat_port:
      return std::make_unique<LaneScorer<refractive::LensFlatPortCamera, Narrow, Wide>>(tables);
    case CameraKind::lens_dome_port:
      return std::make_unique<LaneScorer<refractive::LensDomePortCamera, Narrow, Wide>>(tables);
    default:
      return nullptr;
  }
}

}  // namespace axial::depth::lanes
