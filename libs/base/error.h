// SPDX-License-Identifier: GPL-3.0-or-later
// Errors that a user can cause. Programs print the message as one line and exit with code 1.
#pragma once

#include <fmt/format.h>

#include "axial/base.h"

namespace axial {

// Do the work of fail() and fail_in() in error.cpp, so that the formatting is compiled in one
// place.
[[noreturn]] void fail_formatted(fmt::string_view format, fmt::format_args arguments);
[[noreturn]] void fail_formatted_in(const std::filesystem::path& file, fmt::string_view format,
                                    fmt::format_args arguments);

// Throws an Error whose message is `format` with `args` in place of its "{}" (fmt's syntax).
template <class... Args>
[[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) {
  fail_formatted(format, fmt::make_format_args(args...));
}

// The same with "<file>: " before the message: an Error of `file`, which is a file or a place in a
// file ("a.txt: line 3").
template <class... Args>
[[noreturn]] void fail_in(const std::filesystem::path& file, fmt::format_string<Args...> format,
                          Args&&... args) {
  fail_formatted_in(file, format, fmt::make_format_args(args...));
}

// Error::text() of an Error, and what() of another exception.
std::string marked_text(const std::exception& error);

}  // namespace axial
