// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: reads and writes ports, their standard deviations and the distortion of
// lenses in JSON. Housing files, lens files and the side files of depth maps contain them.
#pragma once

#include <string>

#include "axial/base.h"
#include "bytes/private/only_for_io.h"
#include "io/bytes/json.h"
#include "io/bytes/json_place.h"
#include "io/cameras/port_sigmas.h"
#include "refractive/lens_distortion.h"
#include "refractive/port.h"
#include "scene/water_surface.h"

namespace axial::io {

// The largest distance of a housing's flat port from the camera [m]. A larger value is probably in
// a wrong unit.
inline constexpr double kLongestGap = 1;

// Read and write a port of the type "flat" or "dome". Reading gives an Error for an unknown key,
// another type, values that are not possible, or a flat port farther than `longest_gap` [m] from
// the camera. A normal whose length differs from 1 by more than 1e-6 is normalised with a warning
// of `context`.
refractive::Port<double> port_from_json(const JsonPlace& place, double longest_gap,
                                        const Context& context);
nlohmann::json port_to_json(const refractive::Port<double>& port);

// Recognise, read and write a port of the type "water-surface". Reading gives an Error for an
// unknown key and for values that are not possible. Normals as in port_from_json().
bool is_water_surface(const JsonPlace& place);
WaterSurface water_surface_from_json(const JsonPlace& place, const Context& context);
nlohmann::json water_surface_to_json(const WaterSurface& surface);

// Returns `n` normalised. If the length differs from 1 by no more than rounding (1e-15), `n` is
// returned unchanged. Warns through `context` if the length differs from 1 by more than 1e-6. Error
// that starts with `where` if the length is not above 1e-6 or not finite.
Eigen::Vector3d unit_normal(const Eigen::Vector3d& n, const std::string& where,
                            const Context& context);

// Error that starts with `where` for values that are not possible. The comment of read_housing
// (housing.h) lists these values.
void check_port(const refractive::Port<double>& port, const std::string& where);
void check_water_surface(const WaterSurface& surface, const std::string& where);

// Reads the object "sigma" of a port. `is_dome`: the kind of the port, on which the keys depend. A
// number in place of a list applies to all components. Error for an unknown key and for a value
// that is not above 0 or not possible: more than 90 degrees, 1 m, or 1 for the index.
PortSigmas sigmas_from_json(const JsonPlace& place, bool is_dome);

// Returns the object "sigma". Precondition: `sigmas` is not empty.
nlohmann::json sigmas_to_json(const PortSigmas& sigmas);

// Reads or writes a distortion (docs/formats.md). Keys that are missing keep the values of a lens
// without distortion. Error for an unknown key, a type other than "perspective" and "fisheye", too
// many coefficients, or a "spread" or first radial coefficient that is not positive.
refractive::LensDistortion<double> distortion_from_json(const JsonPlace& place);
nlohmann::json distortion_to_json(const refractive::LensDistortion<double>& distortion);

}  // namespace axial::io
