// SPDX-License-Identifier: GPL-3.0-or-later
// Ends a program that has run out of memory with a message, whichever thread or library fails.
#pragma once

#include <exception>

namespace axial {

// Whether `error` reports that memory ran out: it is a std::bad_alloc, or its message contains the
// text with which the standard library, the system or OpenCV reports it.
bool is_out_of_memory(const std::exception& error);

// From now on an uncaught exception ends the program with exit code 1 and one line on standard
// error: "NAME: out of memory", or "NAME: " and the exception's message. This includes exceptions
// of other threads and exceptions while a library is initialised. NAME is the name of the running
// file. std::terminate() without an exception aborts as before.
void report_uncaught_exceptions();

}  // namespace axial
