// SPDX-License-Identifier: GPL-3.0-or-later
// Errors that a user can cause. Programs print the message as one line and exit with code 1.
#pragma once

#include <fmt/format.h>

#include "axial/base.h"

namespace axial {

// Does the work of fail() in error.cpp, so that the formatting is compiled in one place.
[[noreturn]] void fail_formatted(fmt::string_view format, fmt::format_args arguments);

// Throws an Error whose message is `format` with `args` in place of its "{}" (fmt's syntax).
// as_message() (base/message.h) makes the message one line of at most 500 bytes.
template <class... Args>
[[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) {
  fail_formatted(format, fmt::make_format_args(args...));
}

}  // namespace axial
