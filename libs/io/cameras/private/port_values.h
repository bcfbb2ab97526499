// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: warns of values of ports that are possible but not realistic under water. A
// wrong unit, index or direction gives such values. Values that are not possible are errors of
// check_port. Warnings go through `context`.
#pragma once

#include <string>

#include "axial/base.h"
#include "bytes/private/only_for_io.h"
#include "io/cameras/housing.h"
#include "scene/scene.h"

namespace axial::io {

// Warns of each field of `port` that is outside its usual range: n_water outside 1.30 to 1.40,
// n_glass outside 1.30 to 2.00, or a flat port's normal more than 30 degrees from the optical axis.
// A flat or dome port whose indices are all 1 has no effect and gives no warning. Warnings start
// with `where`.
void warn_of_port_values(const HousingPort& port, const std::string& where, const Context& context);

// Compares the ports that are attached to the scene's images with the sparse points. An observation
// is a view of a sparse point in an image with a port. Points behind the camera do not count. Warns
// of a port in two cases:
// - More than half of its observations are of points that are not beyond the port. The scene would
//   be inside the housing, or above the water.
// - More than half of its observations are of points behind more than 25 m of water. Hardly any
//   photograph can be matched through so much water.
// A port gives at most one warning. Warnings are in the order of the port names and start with
// "`file`: housing.ports.NAME".
void warn_of_ports_in_scene(const Scene& scene, const Housing& housing, const std::string& file,
                            const Context& context);

}  // namespace axial::io
