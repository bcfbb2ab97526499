// SPDX-License-Identifier: GPL-3.0-or-later
// A port of either kind, for code that passes on ports but does not use their parameters.
#pragma once

#include <variant>

#include "refractive/dome_port.h"
#include "refractive/flat_port.h"

namespace axial::refractive {

template <class T>
using Port = std::variant<FlatPort<T>, DomePort<T>>;

}  // namespace axial::refractive
