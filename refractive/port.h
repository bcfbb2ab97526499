// SPDX-License-Identifier: BSD-3-Clause
// A port of either kind: flat (FlatPort) or dome (DomePort).
#pragma once

#include <variant>

#include "refractive/dome_port.h"
#include "refractive/flat_port.h"

namespace axial::refractive {

template <class T>
using Port = std::variant<FlatPort<T>, DomePort<T>>;

}  // namespace axial::refractive
