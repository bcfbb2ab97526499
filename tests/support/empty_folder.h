// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

namespace axial::test {

// An empty folder of the running test's own. Tests run side by side, those of one fixture too, and
// each a second time in the sanitized build: no fixed name under the temporary folder is safe.
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
