// SPDX-License-Identifier: GPL-3.0-or-later
// Warnings of port values that are possible but not realistic under water, as from a wrong unit,
// index or direction. Values that no camera could work with are errors of check_port.
#pragma once

#include <span>
#include <string>

#include "io/cameras/housing.h"
#include "io/colmap/colmap.h"
#include "private/only_for_io.h"
#include "scene/scene.h"

namespace axial::io {

// Warns of each field of `port` that is outside its usual range: n_water outside 1.30 to 1.40,
// n_glass outside 1.30 to 2.00, or a flat port's normal more than 30 degrees from the optical axis.
// A port whose indices are all 1 has no effect and gives no warning. Warnings start with `where`.
void warn_of_port_values(const HousingPort& port, const std::string& where);

// The same for the ports of `cameras`, once for each distinct port. Warnings start with "`file`:
// camera ID: port".
void warn_of_port_values(std::span<const ColmapCamera> cameras, const std::string& file);

// Compares the ports attached to the scene's images with its sparse points. Warns of each port that
// - is farther from the camera than more than half of the points seen through it (the scene would
//   be inside the housing, or above the water), or
// - has more than half of these points behind more than 25 m of water, through which hardly any
//   photograph can be matched.
// At most one warning for each port, in the order of the port names. Warnings start with "`file`:
// housing.ports.NAME".
void warn_of_ports_in_scene(const Scene& scene, const Housing& housing, const std::string& file);

}  // namespace axial::io
