// SPDX-License-Identifier: GPL-3.0-or-later
// Base64 (RFC 4648).
#pragma once

#include <string>
#include <string_view>

namespace axial {

// The bytes in base64, padded with "=".
std::string base64(std::string_view bytes);

// The bytes that the text stands for. The padding may be missing, and '-' and '_' may stand for '+'
// and '/'. Error that begins with `owner` for a text of a wrong length, and for another character,
// with its index.
std::string base64_decoded(std::string_view text, const std::string& owner);

}  // namespace axial
