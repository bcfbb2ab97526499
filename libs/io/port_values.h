// SPDX-License-Identifier: GPL-3.0-or-later
// Warnings of values that a port can have on paper but none has under water: a mistaken unit,
// index or direction. Values that no camera could work with are errors of check_port.
#pragma once

#include <span>
#include <string>

#include "io/colmap.h"
#include "io/housing.h"
#include "scene/scene.h"

namespace axial::io {

// A warning for each field of `port` out of its usual range, starting with `where`: n_water outside
// 1.30 to 1.40, n_glass outside 1.30 to 2.00, and a flat port's normal more than 30 degrees from
// the optical axis. A port whose indices are all 1 is none, and passes.
void warn_of_port_values(const HousingPort& port, const std::string& where);

// The same for the ports that cameras carry, each port once, starting with "`file`: camera ID:
// port".
void warn_of_port_values(std::span<const ColmapCamera> cameras, const std::string& file);

// A warning, starting with "`file`: housing.ports.NAME", for each port of the scene's images
//   that reaches farther than half of the sparse points that they see (the scene would be inside
//   the housing, or above the water), or
//   through which half of the points are farther than 25 m: hardly any water is clear enough.
// Ports as they are attached to the images; one warning a port, in the order of their names.
void warn_of_ports_in_scene(const Scene& scene, const Housing& housing, const std::string& file);

}  // namespace axial::io
