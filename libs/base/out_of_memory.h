// SPDX-License-Identifier: GPL-3.0-or-later
// The end of a program that has no memory left, in whatever thread or library it notices.
#pragma once

#include <exception>

namespace axial {

// Whether `error` says that memory ran out: as std::bad_alloc, or in the words of the system or of
// OpenCV, also within the message of another error.
bool is_out_of_memory(const std::exception& error);

// From now on an exception that nothing catches, also of another thread or out of a library's
// initialisation, ends the program with exit code 1 and one line on standard error, "NAME: out of
// memory" or "NAME: " and what the exception says. NAME is that of the running file. An abort
// without an exception stays one.
void report_uncaught_exceptions();

}  // namespace axial
