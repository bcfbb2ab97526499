// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace axial::apps {

// Returns the option that sets a field of densify::Settings: "--max-memory" for "max_memory". For a
// field with a value ("make_maps false"), returns the option with the value. Used as
// Settings::name_of.
std::string option_of(std::string_view setting);

}  // namespace axial::apps
