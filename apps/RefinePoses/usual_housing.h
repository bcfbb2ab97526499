// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "io/cameras/housing.h"
#include "pose/port_kind.h"

namespace axial::apps {

// Whether `word` is a value of --housing that names a kind of port instead of a file: flat, dome or
// unknown.
bool is_usual_housing(std::string_view word);

// The kind of port of such a word; nothing for "unknown".
std::optional<pose::PortKind> kind_named(std::string_view word);

// A housing of pose::usual_port() for all images, with wide standard deviations: 3 degrees for the
// normal, 3 cm for the distance, 1 cm for the centre of a dome, and 0.004 for the index of the
// water. Precondition: the kind is a port.
io::Housing usual_housing(pose::PortKind kind);

}  // namespace axial::apps
