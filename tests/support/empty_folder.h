// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

namespace axial::test {

// Creates an empty folder for the running test. The name of the folder contains the name of the
// test and the process number, because tests run in parallel and may run in two builds at the same
// time.
inline std::filesystem::path empty_folder() {
  const auto* info = testing::UnitTest::GetInstance()->current_test_info();
  const auto folder = std::filesystem::path(testing::TempDir()) /
                      (std::string("axial_") + info->test_suite_name() + "_" + info->name() + "_" +
                       std::to_string(::getpid()));
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

// A test with an empty folder, which is removed after the test.
class FolderTest : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_ = empty_folder();
};

}  // namespace axial::test
