// SPDX-License-Identifier: GPL-3.0-or-later
// Keeps messages of libraries, which also throw exceptions, away from standard error.
#pragma once

namespace axial {

// From now on, QuietErrors has its effect: puts a filter before the buffer of std::cerr.
// run_program() calls this function. In a program of a library's user, std::cerr stays as it is.
void filter_errors();

// While the object exists, what its thread writes to std::cerr is left out, if filter_errors() was
// called.
class QuietErrors {
 public:
  QuietErrors();
  ~QuietErrors();
  QuietErrors(const QuietErrors&) = delete;
  QuietErrors& operator=(const QuietErrors&) = delete;
};

}  // namespace axial
