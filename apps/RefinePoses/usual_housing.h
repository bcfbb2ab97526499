// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "diagnosis/port_kind.h"
#include "io/cameras/housing.h"

namespace axial::apps {

// Whether `word` is a value of --housing that names a kind of port instead of a file: flat, dome or
// unknown.
bool is_usual_housing(std::string_view word);

// The kind of port of such a word; nothing for "unknown".
std::optional<pose::PortKind> kind_named(std::string_view word);

// A housing of diagnosis::usual_port() for all images, with the standard deviations of
// diagnosis::usual_sigmas(). Precondition: the kind is a port.
io::Housing usual_housing(pose::PortKind kind);

}  // namespace axial::apps
