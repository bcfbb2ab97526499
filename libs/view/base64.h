// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace axial::view {

// The bytes in base64 (RFC 4648), padded with "=".
std::string base64(std::string_view bytes);

}  // namespace axial::view
