// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/program/quiet_errors.h"

#include <gtest/gtest.h>

#include <iostream>
#include <thread>

namespace axial {
namespace {

TEST(QuietErrors, LeaveOutWhatTheirThreadWrites) {
  filter_errors();
  testing::internal::CaptureStderr();
  {
    const QuietErrors quiet;
    std::cerr << "left out, ";
    std::thread([] { std::cerr << "another thread, "; }).join();
  }
  std::cerr << "afterwards" << std::flush;
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "another thread, afterwards");
}

}  // namespace
}  // namespace axial
