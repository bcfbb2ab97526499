// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/program/standard_streams.h"

#include <fcntl.h>

#include <cerrno>

namespace axial {

// In ascending order, because open() returns the lowest free descriptor.
void open_standard_streams() {
  for (int descriptor = 0; descriptor < 3; ++descriptor)
    if (::fcntl(descriptor, F_GETFD) < 0 && errno == EBADF) ::open("/dev/null", O_RDWR);
}

}  // namespace axial
