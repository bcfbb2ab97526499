// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace axial::apps {

// The option for a field of densify::Settings, for Settings::name_of: "--max-memory" for
// "max_memory". For a field with a value, the option with its value.
std::string option_of(std::string_view setting);

}  // namespace axial::apps
