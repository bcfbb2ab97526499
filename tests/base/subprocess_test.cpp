// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/subprocess.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <thread>

#include "base/atomic_file.h"
#include "support/empty_folder.h"
#include "support/error_of.h"

namespace axial {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Subprocess : public testing::Test {
 protected:
  fs::path folder_ = test::empty_folder();
  fs::path log_ = folder_ / "subprocess.log";
  void TearDown() override { fs::remove_all(folder_); }

  std::string error_of(const std::vector<std::string>& command) {
    return test::error_of([&] { run_subprocess(command, log_); });
  }
};

TEST_F(Subprocess, ArgumentsArriveAsTheyAre) {
  run_subprocess({"printf", "%s|", "a b", "", "$HOME", "'\"", "*"}, log_);
  EXPECT_EQ(read_file(log_), "a b||$HOME|'\"|*|");
}

TEST_F(Subprocess, BothStreamsAreLoggedAndInputIsEmpty) {
  run_subprocess({"sh", "-c", "echo out; echo err >&2; cat"}, log_);
  EXPECT_EQ(read_file(log_), "out\nerr\n");
}

TEST_F(Subprocess, AnOldLogIsReplaced) {
  write_atomically(log_, "much longer than what comes");
  run_subprocess({"echo", "new"}, log_);
  EXPECT_EQ(read_file(log_), "new\n");
}

TEST_F(Subprocess, FailuresNameTheProgramAndItsLastWords) {
  const std::string said = error_of({"sh", "-c", "echo first; echo 'no more disk'; exit 3"});
  EXPECT_THAT(said, HasSubstr("sh: exit code 3"));
  EXPECT_THAT(said, HasSubstr(log_.string()));
  EXPECT_THAT(said, HasSubstr("no more disk"));
  EXPECT_THAT(said, testing::Not(HasSubstr("first")));
  EXPECT_THAT(error_of({"sh", "-c", "kill -9 $$"}), HasSubstr("signal 9"));
  EXPECT_THAT(error_of({"no-such-program"}), HasSubstr("no-such-program: cannot be started"));
}

TEST_F(Subprocess, OnlyAPlainFailureThatSaysSoIsExcused) {
  const auto run = [&](const std::string& script) {
    return run_unless_excused({"sh", "-c", script}, log_, {"found nothing"});
  };
  EXPECT_TRUE(run("echo found nothing"));
  EXPECT_FALSE(run("echo found nothing; echo bye; exit 1"));
  for (const char* script : {"exit 1", "echo found nothing; exit 2", "echo found nothing; kill $$"})
    EXPECT_NE(test::error_of([&] { run(script); }), "") << script;
}

// The write end of the pipe is closed when the last process that holds it ends.
TEST_F(Subprocess, DoesNotOutliveItsParent) {
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  const pid_t parent = fork();
  if (parent == 0) {
    run_subprocess({"sh", "-c", "echo started; exec sleep 60"}, log_);
    _exit(0);
  }
  close(ends[1]);
  while (!fs::is_regular_file(log_) || read_file(log_).empty())
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  kill(parent, SIGKILL);
  waitpid(parent, nullptr, 0);
  constexpr int kPatience = 20000;  // [ms]
  pollfd end{ends[0], POLLIN, 0};
  EXPECT_EQ(poll(&end, 1, kPatience), 1);
  close(ends[0]);
}

TEST_F(Subprocess, TheProgramsOwnFolder) {
  EXPECT_TRUE(fs::equivalent(program_folder() / program_invocation_short_name, "/proc/self/exe"));
}

}  // namespace
}  // namespace axial
