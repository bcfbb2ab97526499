// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/geometry: Embree's errors as Errors of one line, in our words.
#pragma once

#include <embree3/rtcore.h>

#include <cstddef>

namespace axial::geometry {

// Throws an Error if Embree has reported one since the last call. `device` is null: while a device
// was made. `faces`: the number of faces of the mesh, for the message.
void require_no_error(RTCDevice device, std::size_t faces);

}  // namespace axial::geometry
