// SPDX-License-Identifier: GPL-3.0-or-later
// The scorer for one instruction set and cameras with distorted lenses. To be included by its
// translation unit alone, which is not that of straight lenses: they compile to the same code
// whether there are others or not.
#pragma once

#include "depth/lanes/lane_scorer.h"
#include "refractive/lens_camera.h"

namespace axial::depth::lanes {

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
