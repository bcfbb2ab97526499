// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/progress.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>

#include "base/log.h"
#include "base/program/program.h"

namespace axial {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::MatchesRegex;
using testing::Not;

// Returns the output of a program that processes four items with a warning after the second, at the
// log level `level`. Its standard output is `file`, which is closed afterwards. `reader` is open on
// the same file or terminal. It is read to its end, because a terminal may deliver the output in
// pieces.
std::string written(int file, int reader, LogLevel level) {
  std::fflush(stdout);
  const int kept = ::dup(STDOUT_FILENO);
  ::dup2(file, STDOUT_FILENO);
  run_program("Test", [&] {
    set_log_level(level);
    const ProgressSink progress = console_progress("Done things");
    for (std::size_t done = 1; done <= 4; ++done) {
      progress(done, 4);
      if (done == 2) log_warning("careful");
    }
    std::fflush(stdout);
    return 0;
  });
  ::dup2(kept, STDOUT_FILENO);
  ::close(kept);
  ::close(file);
  std::string text;
  std::array<char, 4096> piece;
  for (ssize_t size; (size = ::read(reader, piece.data(), piece.size())) > 0;)
    text.append(piece.data(), static_cast<std::size_t>(size));
  return text;
}

std::string on_terminal(LogLevel level) {
  const int terminal = ::posix_openpt(O_RDWR | O_NOCTTY);
  EXPECT_EQ(::grantpt(terminal), 0);
  EXPECT_EQ(::unlockpt(terminal), 0);
  const int program_side = ::open(::ptsname(terminal), O_RDWR | O_NOCTTY);
  EXPECT_NE(::isatty(program_side), 0);
  const std::string text = written(program_side, terminal, level);
  ::close(terminal);
  return text;
}

std::string in_file(LogLevel level) {
  std::FILE* file = std::tmpfile();
  const int reader = ::open(("/proc/self/fd/" + std::to_string(::fileno(file))).c_str(), O_RDONLY);
  const std::string text = written(::dup(::fileno(file)), reader, level);
  ::close(reader);
  std::fclose(file);
  return text;
}

TEST(Progress, TheFirstItemsGiveNoEstimate) {
  testing::internal::CaptureStdout();
  set_log_level(LogLevel::debug);
  const ProgressSink progress = console_progress("Done things");
  progress(1, 1000);
  const ProgressSink later = console_progress("Done more");
  later(50, 1000);
  set_log_level(LogLevel::info);
  const std::string text = testing::internal::GetCapturedStdout();
  EXPECT_THAT(text, HasSubstr("Done things 1/1000 (0%, 0s)"));
  EXPECT_THAT(text, HasSubstr("Done more 50/1000 (5%, 0s, 0s left)"));
}

TEST(Progress, RewritesOneLineOnATerminal) {
  const std::string text = on_terminal(LogLevel::debug);
  EXPECT_THAT(text, HasSubstr("\rDone things 1/4 (25%, 0s, 0s left)\033[K"));
  EXPECT_THAT(text, ContainsRegex("\r\033\\[K.*\\[Test\\] Done things 4/4 \\(100%, 0.0s\\)"));
  EXPECT_THAT(text, ContainsRegex("left\\)\033\\[K\r\033\\[K[0-9:]+ \\[Test\\] warning: careful"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2) << text;
}

TEST(Progress, WritesPlainLinesIntoAFile) {
  const std::string text = in_file(LogLevel::debug);
  EXPECT_THAT(text, HasSubstr("[Test] Done things 1/4 (25%, 0s, 0s left)\n"));
  EXPECT_THAT(text, HasSubstr("[Test] Done things 4/4 (100%, 0.0s)\n"));
  EXPECT_THAT(text, Not(HasSubstr("\r")));
  EXPECT_THAT(text, Not(HasSubstr("\033")));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3)
      << "more than every few seconds: " << text;
}

TEST(Progress, IsSilentWhereTheLogIs) {
  for (const auto& output : {on_terminal, in_file}) {
    const std::string ends = output(LogLevel::info);
    EXPECT_THAT(ends, HasSubstr("Done things 4/4"));
    EXPECT_THAT(ends, Not(HasSubstr("1/4")));
    EXPECT_THAT(output(LogLevel::warning),
                MatchesRegex("(\r\033\\[K)?[0-9:]+ \\[Test\\] warning: careful\r?\n"));
  }
}

}  // namespace
}  // namespace axial
