// SPDX-License-Identifier: GPL-3.0-or-later
// The value I/N of options such as --part and --tile.
#pragma once

#include <cstddef>
#include <string>

namespace axial {

// The part `part` of `count` parts, counted from 1.
struct Fraction {
  std::size_t part = 0, count = 0;
};

// Parses the value "I/N" of the option `option` ("--part"). Throws an Error that names the option
// and the value unless N is from 1 to `most` and I is from 1 to N.
Fraction parse_fraction(const std::string& option, const std::string& value, std::size_t most);

}  // namespace axial
