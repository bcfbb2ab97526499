// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: reads and writes the standard deviations of a port in a housing file.
#pragma once

#include "io/cameras/port_sigmas.h"
#include "private/cameras/port_json.h"
#include "private/only_for_io.h"

namespace axial::io {

// Reads the object "sigma" of a port. `is_dome`: the kind of the port, on which the keys depend. A
// number in place of a list applies to all components. Error for an unknown key and for a value
// that is not above 0 or not possible: more than 90 degrees, 1 m, or 1 for the index.
PortSigmas sigmas_from_json(const JsonPlace& place, bool is_dome);

// Returns the object "sigma". Precondition: `sigmas` is not empty.
nlohmann::json sigmas_to_json(const PortSigmas& sigmas);

}  // namespace axial::io
