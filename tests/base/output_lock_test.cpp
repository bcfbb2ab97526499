// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/output_lock.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): ::kill is not in <csignal>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <optional>
#include <string>

#include "base/atomic_file.h"
#include "support/empty_folder.h"
#include "support/error_of.h"

namespace axial {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;

struct Locked : testing::Test {
  Locked() : output(test::empty_folder() / "scene_dense.mvs"), file(output.string() + ".lock") {}
  std::string error(LockUse use) const {
    return test::error_of([&] { const OutputLock lock(output, use); });
  }
  fs::path output, file;
};

// A process that locks the output and waits to be killed.
struct Holder {
  explicit Holder(const fs::path& output, LockUse use) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) ADD_FAILURE() << "no pipe";
    process = ::fork();
    if (process == 0) {
      const OutputLock lock(output, use);
      if (::write(ends[1], "x", 1) == 1) ::pause();
      ::_exit(0);
    }
    char byte = 0;
    EXPECT_EQ(::read(ends[0], &byte, 1), 1);
    ::close(ends[0]);
    ::close(ends[1]);
  }
  ~Holder() { kill(); }
  void kill() {
    if (process <= 0) return;
    ::kill(process, SIGKILL);
    ::waitpid(process, nullptr, 0);
    process = 0;
  }
  pid_t process = 0;
};

TEST_F(Locked, ASecondRunIsToldWhoWrites) {
  const Holder other(output, LockUse::alone);
  for (const LockUse use : {LockUse::alone, LockUse::shared})
    EXPECT_THAT(error(use), AllOf(HasSubstr(output.string() + ": another run writes it: process " +
                                            std::to_string(other.process) + " on "),
                                  ContainsRegex("since 20..-..-.. ..:..:..")));
}

TEST_F(Locked, RunsThatWritePartsShareAnOutput) {
  Holder other(output, LockUse::shared);
  {
    const OutputLock part(output, LockUse::shared);
    EXPECT_THAT(error(LockUse::alone), HasSubstr("another run"));
  }
  EXPECT_TRUE(fs::exists(file));  // the other process still uses it
  EXPECT_THAT(error(LockUse::alone), HasSubstr("another run"));
  other.kill();
  { const OutputLock lock(output); }
  EXPECT_FALSE(fs::exists(file));
}

TEST_F(Locked, AKilledRunLeavesNoLock) {
  Holder other(output, LockUse::alone);
  other.kill();
  EXPECT_TRUE(fs::exists(file));
  { const OutputLock lock(output); }
  EXPECT_FALSE(fs::exists(file));
}

TEST_F(Locked, OtherOutputsAreFree) {
  const Holder other(output, LockUse::alone);
  const OutputLock lock(output.parent_path() / "scene.mvs");
  EXPECT_TRUE(fs::exists(output.parent_path() / "scene.mvs.lock"));
}

// For example the file scene_dense.mvs.lock of a program that keeps versions of files.
TEST_F(Locked, AFileOfAnotherProgramIsKept) {
  for (const std::string text : {"packages = []\n", "12 apples\n", "7 a b c d\n", "\n"}) {
    write_atomically(file, text);
    EXPECT_THAT(error(LockUse::alone), HasSubstr(file.string() + ": is not a lock"));
    EXPECT_THAT(error(LockUse::shared), HasSubstr(file.string() + ": is not a lock"));
    EXPECT_EQ(read_file(file), text);
  }
}

TEST_F(Locked, TheLockOfAFolderIsBesideTheFolder) {
  const Holder other(output, LockUse::alone);
  fs::create_directories(output);
  EXPECT_THAT(test::error_of([&] { const OutputLock lock(output / ""); }),
              HasSubstr(output.string() + ": another run"));
  EXPECT_TRUE(fs::is_empty(output));
}

TEST_F(Locked, TheFolderOfALockedOutputIsMade) {
  const fs::path folder = output.parent_path() / "new" / "page";
  const OutputLock lock = lock_output(folder / "");
  EXPECT_TRUE(fs::exists(folder.string() + ".lock"));
  EXPECT_FALSE(fs::exists(folder));
}

TEST_F(Locked, OnlyFoldersWithFilesOutliveTheLock) {
  const fs::path kept = output.parent_path() / "kept";
  {
    const OutputLock empty = lock_output(output.parent_path() / "new" / "dir" / "map");
    const OutputLock used = lock_output(kept / "dir" / "map");
    write_atomically(kept / "file", "text");
  }
  EXPECT_FALSE(fs::exists(output.parent_path() / "new"));
  EXPECT_FALSE(fs::exists(kept / "dir"));
  EXPECT_TRUE(fs::exists(kept / "file"));
  const fs::path older = output.parent_path() / "older";
  fs::create_directory(older);
  { const OutputLock lock = lock_output(older / "map"); }
  EXPECT_TRUE(fs::exists(older));
}

TEST_F(Locked, AFolderThatDoesNotExistIsNotLocked) {
  const OutputLock lock(output.parent_path() / "none" / "scene.mvs");
  EXPECT_FALSE(fs::exists(output.parent_path() / "none"));
}

}  // namespace
}  // namespace axial
