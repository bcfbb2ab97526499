// SPDX-License-Identifier: GPL-3.0-or-later
// The names of settings in messages. A library does not know the options of programs. Messages of a
// library call a setting as its headers do, for example "max_memory", unless the caller supplies
// other names.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace axial {

// A function that returns the words by which a message calls `setting`. `setting` is the name of a
// field or of a parameter ("max_memory"), or this name with a value ("make_maps false").
using SettingNames = std::function<std::string(std::string_view setting)>;

// Returns `setting` itself.
inline std::string own_name(std::string_view setting) {
  return std::string(setting);
}

}  // namespace axial
