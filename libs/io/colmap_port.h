// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: a port as COLMAP-Underwater and Calibmar write it, eight numbers in order.
//
//     FLATPORT  Nx Ny Nz distance thickness n_air n_glass n_water
//     DOMEPORT  Cx Cy Cz inner_radius thickness n_air n_glass n_water
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "refractive/port.h"

namespace axial::io {

inline constexpr std::size_t kPortNumbers = 8;
using PortNumbers = std::array<double, kPortNumbers>;

// "FLATPORT" or "DOMEPORT"; their numbers in binary files are 0 and 1, and -1 is no port.
std::string_view port_word(const refractive::Port<double>& port);
std::string_view port_word(int number);  // empty if there is none of that number
bool is_port_word(std::string_view word);
int port_number(const refractive::Port<double>& port);

PortNumbers port_numbers(const refractive::Port<double>& port);

// Error that starts with `where` for another word, or values no port has. A normal off unit length
// is normalised, with a warning beyond 1e-6.
refractive::Port<double> port_from(std::string_view word, const PortNumbers& numbers,
                                   const std::string& where);

}  // namespace axial::io
