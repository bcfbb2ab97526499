// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/output_lock.h"

#include <fcntl.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): ::kill is not in <csignal>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <ctime>
#include <sstream>
#include <string>

#include "base/error.h"
#include "base/without_slash.h"

namespace axial {
namespace {

namespace fs = std::filesystem;

std::string machine_name() {
  std::array<char, 256> name{};
  ::gethostname(name.data(), name.size() - 1);
  return name.data();
}

// The line of this process in the file.
std::string line_of_this_process() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  ::localtime_r(&now, &local);
  std::array<char, 32> time{};
  std::strftime(time.data(), time.size(), "%Y-%m-%d %H:%M:%S", &local);
  return fmt::format("{} {} {}\n", ::getpid(), machine_name(), time.data());
}

std::string content_of(int descriptor) {
  std::array<char, 1 << 16> bytes{};
  const ssize_t count = ::pread(descriptor, bytes.data(), bytes.size(), 0);
  return {bytes.data(), count > 0 ? static_cast<std::size_t>(count) : 0};
}

bool holder_has_ended(long process, const std::string& machine) {
  return machine == machine_name() && ::kill(static_cast<pid_t>(process), 0) != 0 && errno == ESRCH;
}

// The process that holds the lock, in words. Several may hold it: the one that came last.
std::string holder_in(const std::string& content) {
  std::istringstream lines(content);
  std::string holder = "a process that is not known", machine, day, time;
  for (long process = 0; lines >> process >> machine >> day >> time;)
    if (!holder_has_ended(process, machine))
      holder = fmt::format("process {} on {}, since {} {}", process, machine, day, time);
  return holder;
}

// Whether `file` is still the file that was opened, and was not removed in between.
bool is_file(int descriptor, const fs::path& file) {
  struct stat open {
  }, named{};
  return ::fstat(descriptor, &open) == 0 && ::stat(file.c_str(), &named) == 0 &&
         open.st_dev == named.st_dev && open.st_ino == named.st_ino;
}

// Whether a file of this content is a lock: it is empty, or its first line is one that
// note_this_process() writes.
bool is_lock(const std::string& content) {
  std::istringstream line(content.substr(0, content.find('\n')));
  std::string machine, day, time, more;
  long process = 0;
  if (content.empty()) return true;
  return (line >> process >> machine >> day >> time) && !(line >> more) && process > 0 &&
         day.size() == 10 && day[4] == '-' && day[7] == '-' && time.size() == 8;
}

enum class Outcome { locked, held_by_others, no_locks };

Outcome try_lock(int descriptor, int operation) {
  while (::flock(descriptor, operation | LOCK_NB) != 0) {
    if (errno == EINTR) continue;
    return errno == EWOULDBLOCK ? Outcome::held_by_others : Outcome::no_locks;
  }
  return Outcome::locked;
}

// A process that cannot note itself has the lock all the same.
void note_this_process(int descriptor, LockUse use) {
  const std::string line = line_of_this_process();
  const bool emptied = use == LockUse::shared || ::ftruncate(descriptor, 0) == 0;
  [[maybe_unused]] const ssize_t written =
      emptied ? ::write(descriptor, line.data(), line.size()) : 0;
}

// Makes the folder of a file and its parents as far as it can. Returns the missing ones, the
// deepest first.
std::vector<fs::path> make_missing_folders_of(const fs::path& file) {
  std::vector<fs::path> missing;
  std::error_code ignored;
  const fs::path folder = fs::absolute(file, ignored).parent_path();
  for (fs::path at = folder; !fs::exists(at, ignored) && at.has_relative_path();
       at = at.parent_path())
    missing.push_back(at);
  fs::create_directories(folder, ignored);
  return missing;
}

}  // namespace

OutputLock::OutputLock(fs::path output, LockUse use, ParentFolder parent) {
  output = without_slash(output);
  if (parent == ParentFolder::made) made_ = make_missing_folders_of(output);
  file_ = output.string() + ".lock";
  const int operation = use == LockUse::alone ? LOCK_EX : LOCK_SH;
  // A file that another process removed while this one opened it locks nothing. The number of
  // attempts is limited, because some file systems never state the same number for the same file.
  constexpr int kAttempts = 1000;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const int opened = ::open(file_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (opened < 0) return;
    const Outcome outcome = try_lock(opened, operation);
    const std::string content = content_of(opened);
    if (outcome == Outcome::locked && is_file(opened, file_) && is_lock(content)) {
      descriptor_ = opened;
      note_this_process(opened, use);
      return;
    }
    ::close(opened);
    if (!is_lock(content))
      fail_in(file_, "is not a lock of this program, and would be overwritten: rename it");
    if (outcome == Outcome::no_locks) return;
    if (outcome == Outcome::held_by_others)
      fail_in(output, "another run writes it: {}; start again when that run has ended",
              holder_in(content));
  }
}

OutputLock::~OutputLock() {
  if (descriptor_ >= 0) {
    // Other processes that share the lock keep the file.
    if (try_lock(descriptor_, LOCK_EX) == Outcome::locked && is_file(descriptor_, file_))
      ::unlink(file_.c_str());
    ::close(descriptor_);
  }
  for (const fs::path& folder : made_) ::rmdir(folder.c_str());  // fails if it contains anything
}

OutputLock lock_output(const fs::path& output, LockUse use) {
  return OutputLock(output, use, ParentFolder::made);
}

}  // namespace axial
