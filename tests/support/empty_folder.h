// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

namespace axial::test {

// Creates an empty folder for the running test. Its name contains the test's name and the process
// number: tests run in parallel, also those of one fixture, and each test runs a second time in the
// sanitized build.
inline std::filesystem::path empty_folder() {
  const auto* info = testing::UnitTest::GetInstance()->current_test_info();
  const auto folder = std::filesystem::path(testing::TempDir()) /
                      (std::string("axial_") + info->test_suite_name() + "_" + info->name() + "_" +
                       std::to_string(::getpid()));
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

}  // namespace axial::test
