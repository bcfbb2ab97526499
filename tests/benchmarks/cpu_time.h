// SPDX-License-Identifier: GPL-3.0-or-later
// CPU time instead of wall time, because benchmarks share their machine with other programs.
#pragma once

#include <ctime>

namespace axial::benchmarks {

inline double seconds_of(clockid_t clock) {
  timespec now;
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

inline double thread_cpu_seconds() {
  return seconds_of(CLOCK_THREAD_CPUTIME_ID);
}

inline double process_cpu_seconds() {
  return seconds_of(CLOCK_PROCESS_CPUTIME_ID);
}

}  // namespace axial::benchmarks
