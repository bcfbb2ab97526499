// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/water_surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"

namespace axial {

refractive::FlatPort<double> port_seen_from(const Pose& pose, const WaterSurface& surface,
                                            const std::string& where) {
  refractive::FlatPort<double> port;
  port.normal = pose.rotation * surface.normal;
  port.distance = surface.height_of(pose.centre);
  port.n_air = surface.n_air;
  port.n_glass = port.n_water = surface.n_water;  // without effect, since the thickness is 0
  if (!(port.distance > 0 && std::isfinite(port.distance)))
    fail("{}: the camera's height over the water surface is {} m, but must be positive", where,
         port.distance);
  if (!(port.normal.z() > 0))
    fail(
        "{}: the camera looks away from the water surface: {:.1f} degrees off its normal, but must "
        "be less than 90",
        where, std::acos(std::max(-1.0, port.normal.z())) * 180 / std::numbers::pi);
  return port;
}

}  // namespace axial
