// SPDX-License-Identifier: GPL-3.0-or-later
// A program that has run out of memory ends with a message, whichever thread or library needs the
// memory.
#pragma once

#include <exception>

namespace axial {

// Whether `error` reports that memory ran out: it is a std::bad_alloc, or its message contains the
// words with which the standard library, the system or OpenCV reports the lack of memory.
bool is_out_of_memory(const std::exception& error);

// From now on an uncaught exception ends the program with exit code 1 and one line on standard
// error: "NAME: out of memory", or "NAME: " and the exception's message. This holds for exceptions
// in every thread and for exceptions while a library is initialised. NAME is the name of the
// running file. std::terminate() without an exception aborts as before.
void report_uncaught_exceptions();

}  // namespace axial
