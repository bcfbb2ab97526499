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

// One such option.
struct NotBuilt {
  const char* name;                   // as in Option::name (base/option_list.h)
  std::string value;                  // the default; after parsing, the value that the user gave
  std::vector<std::string> accepted;  // all spellings of the default
};

// Adds `options` to `list`. --help says that they are not built yet. `options` must exist until
// parse_options() (base/program.h) has returned.
void declare_not_built(OptionList& list, std::span<NotBuilt> options);

// Call this function after parse_options(). Throws an Error that names the option and the value if
// the user gave an option a value that is not in `accepted`.
void refuse_not_built(std::span<const NotBuilt> options);

}  // namespace axial
