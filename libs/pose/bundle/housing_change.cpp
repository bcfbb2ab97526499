// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/bundle/housing_change.h"

namespace axial::pose {

HousedCamera with_change(const HousedCamera& measured, const HousingChange<double>& change) {
  HousedCamera camera = measured;
  camera.lens.pinhole = with_change(measured.lens.pinhole, change);
  if (measured.port)
    camera.port = std::visit(
        [&](const auto& port) { return refractive::Port<double>(with_change(port, change)); },
        *measured.port);
  return camera;
}

}  // namespace axial::pose
