// SPDX-License-Identifier: GPL-3.0-or-later
// Runs one of the project's programs in a folder that belongs to the test.
#pragma once

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>

#include "support/empty_folder.h"

namespace axial::test {

struct Outcome {
  int exit_code;
  std::string output;  // standard output and standard error
};

// A fixture with an empty folder, which is removed at the end of the test.
class ProgramTest : public testing::Test {
 protected:
  void SetUp() override { folder_ = empty_folder(); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  Outcome run_program(const std::string& program, const std::string& arguments) const {
    const std::string command = fmt::format("'{}/bin/{}' -w '{}' {} 2>&1", AXIAL_BINARY_DIR,
                                            program, folder_.string(), arguments);
    std::FILE* pipe = popen(command.c_str(), "r");
    std::string output;
    for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe))
      output.push_back(static_cast<char>(c));
    const int status = pclose(pipe);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, output};
  }

  // Expects exit code 0, and returns the output.
  std::string succeed_in(const std::string& program, const std::string& arguments) const {
    const Outcome outcome = run_program(program, arguments);
    EXPECT_EQ(outcome.exit_code, 0) << arguments << "\n" << outcome.output;
    return outcome.output;
  }

  // Expects exit code 1 and exactly one line of output, which contains `expected`.
  void expect_refusal(const std::string& program, const std::string& arguments,
                      const std::string& expected) const {
    const Outcome outcome = run_program(program, arguments);
    EXPECT_EQ(outcome.exit_code, 1) << arguments << "\n" << outcome.output;
    EXPECT_THAT(outcome.output, testing::HasSubstr(expected)) << arguments;
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
  }

  std::filesystem::path folder_;
};

}  // namespace axial::test
