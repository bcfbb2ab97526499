// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/posed_camera.h"

namespace axial::geometry {

std::vector<PosedCamera> posed_cameras(const Scene& scene) {
  std::vector<PosedCamera> cameras;
  for (const SceneImage& image : scene.images)
    if (image.calibrated) cameras.push_back({image.camera, image.pose});
  return cameras;
}

}  // namespace axial::geometry
