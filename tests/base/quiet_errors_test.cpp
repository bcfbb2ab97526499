// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/quiet_errors.h"

#include <gtest/gtest.h>

#include <iostream>
#include <sstream>
#include <thread>

namespace axial {
namespace {

TEST(QuietErrors, LeaveOutWhatTheirThreadWrites) {
  std::ostringstream text;
  std::streambuf* const before = std::cerr.rdbuf(text.rdbuf());
  {
    const QuietErrors quiet;
    std::cerr << "no filter, ";
  }
  filter_errors();
  {
    const QuietErrors quiet;
    std::cerr << "left out, ";
    std::thread([] { std::cerr << "another thread, "; }).join();
  }
  std::cerr << "afterwards";
  std::cerr.rdbuf(before);
  EXPECT_EQ(text.str(), "no filter, another thread, afterwards");
}

}  // namespace
}  // namespace axial
