// SPDX-License-Identifier: GPL-3.0-or-later
// Options of OpenMVS's programs whose function AxialMVS does not have. Each of these options is
// declared and accepts only its default. So scripts for OpenMVS that pass the default work here
// too, and every other value is refused.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/option_list.h"

namespace axial {

struct NotBuilt {
  const char* name;
  std::string value;                  // the default; after parsing, the value that the user gave
  std::vector<std::string> accepted;  // all spellings of the default
};

// Declares `options`, which must exist until parse_options() has returned.
void declare_not_built(OptionList& list, std::span<NotBuilt> options);

// Throws an Error that names the option and the value if an option has a value that is not
// accepted.
void refuse_not_built(std::span<const NotBuilt> options);

}  // namespace axial
