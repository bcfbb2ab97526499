// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: converts a port to and from the form of COLMAP-Underwater and Calibmar. This
// form is a word and eight numbers in the order below. Directions and points are in the camera
// frame. Lengths are in metres.
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

// The kind of a port is a word in text files and a number in binary files: "FLATPORT" is 0 and
// "DOMEPORT" is 1. The number -1 in a binary file means no port.
std::string_view port_word(const refractive::Port<double>& port);
std::string_view port_word(int number);  // empty for an unknown number
bool is_port_word(std::string_view word);
int port_number(const refractive::Port<double>& port);

PortNumbers port_numbers(const refractive::Port<double>& port);

// Returns the port of a word and its numbers. A normal that is not of unit length is normalised,
// with a warning if its length differs from 1 by more than 1e-6. Error that starts with `where` for
// an unknown word or for values that are not possible (check_port).
refractive::Port<double> port_from(std::string_view word, const PortNumbers& numbers,
                                   const std::string& where);

}  // namespace axial::io
