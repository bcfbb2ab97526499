// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/program/standard_streams.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace axial {
namespace {

bool is_dev_null(int descriptor) {
  struct stat actual {
  }, expected{};
  return ::fstat(descriptor, &actual) == 0 && ::stat("/dev/null", &expected) == 0 &&
         actual.st_rdev == expected.st_rdev;
}

// Closes the streams whose bit in `closed` is set in a child process, and calls
// open_standard_streams(). Returns 0 if these streams are then /dev/null, if the other streams have
// not changed, and if the next opened file gets a descriptor above 2.
int opened_again(int closed) {
  const pid_t child = ::fork();
  if (child == 0) {
    bool was_null[3];
    for (int i = 0; i < 3; ++i) was_null[i] = is_dev_null(i);
    for (int i = 0; i < 3; ++i)
      if (closed & 1 << i) ::close(i);
    open_standard_streams();
    bool right = ::open("/", O_RDONLY) > 2;
    for (int i = 0; i < 3; ++i) {
      if (closed & 1 << i)
        right = right && is_dev_null(i);
      else
        right = right && is_dev_null(i) == was_null[i];
    }
    ::_exit(right ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return status;
}

TEST(StandardStreams, AreOpenedWhereTheyAreClosed) {
  for (int closed = 0; closed < 8; ++closed) EXPECT_EQ(opened_again(closed), 0) << closed;
}

}  // namespace
}  // namespace axial
