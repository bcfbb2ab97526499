// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: a port as COLMAP-Underwater and Calibmar write it, eight numbers in this
// order. Directions and points are in the camera frame, lengths in metres.
//
//     FLATPORT  Nx Ny Nz distance thickness n_air n_glass n_water
//     DOMEPORT  Cx Cy Cz inner_radius thickness n_air n_glass n_water
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "private/only_for_io.h"
#include "refractive/port.h"

namespace axial::io {

inline constexpr std::size_t kPortNumbers = 8;
using PortNumbers = std::array<double, kPortNumbers>;

// The word of a port is "FLATPORT" or "DOMEPORT". Its number in binary files is 0 or 1; -1 there
// means no port.
std::string_view port_word(const refractive::Port<double>& port);
std::string_view port_word(int number);  // empty for an unknown number
bool is_port_word(std::string_view word);
int port_number(const refractive::Port<double>& port);

PortNumbers port_numbers(const refractive::Port<double>& port);

// Returns the port. Error that starts with `where` for another word or for values that are not
// possible (check_port). A normal that is not of unit length is normalised, with a warning if the
// difference exceeds 1e-6.
refractive::Port<double> port_from(std::string_view word, const PortNumbers& numbers,
                                   const std::string& where);

}  // namespace axial::io
