// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/subprocess.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>

#include "base/atomic_file.h"
#include "base/error.h"

namespace axial {
namespace {

class Pipe {
 public:
  Pipe() {
    if (pipe2(ends_.data(), O_CLOEXEC) != 0)
      fail("a pipe cannot be made: {}", std::strerror(errno));
  }
  ~Pipe() {
    close_write_end();
    close(ends_[0]);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  int read_end() const { return ends_[0]; }
  int write_end() const { return ends_[1]; }
  void close_write_end() {
    if (ends_[1] >= 0) close(ends_[1]);
    ends_[1] = -1;
  }

 private:
  std::array<int, 2> ends_{-1, -1};
};

// Runs in the child after fork(). Only system calls are safe there, because locks that other
// threads held at fork() are never released. The child must not outlive its parent: it could work
// for hours on files that the next run removes.
[[noreturn]] void become(char* const* arguments, const char* log, pid_t parent, int report) {
  const int in = open("/dev/null", O_RDONLY);
  const int out = open(log, O_WRONLY | O_CREAT | O_TRUNC, 0644);
  const bool ready = in >= 0 && out >= 0 && dup2(in, 0) == 0 && dup2(out, 1) == 1 &&
                     dup2(out, 2) == 2 && prctl(PR_SET_PDEATHSIG, SIGKILL) == 0;
  if (getppid() != parent) _exit(127);
  if (ready) execvp(arguments[0], arguments);
  const int error = errno;
  _exit(write(report, &error, sizeof error) == sizeof error ? 127 : 126);
}

std::string last_line(std::string text) {
  text.erase(text.find_last_not_of(" \n\r") + 1);
  return text.substr(text.find_last_of("\n\r") + 1);
}

int wait_for(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) fail("waiting for process {} failed: {}", child, std::strerror(errno));
  return status;
}

pid_t start(const std::vector<std::string>& command, const std::filesystem::path& log) {
  std::vector<char*> arguments;
  arguments.reserve(command.size() + 1);
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  Pipe report;
  const pid_t parent = getpid(), child = fork();
  if (child == 0) become(arguments.data(), log.c_str(), parent, report.write_end());
  int error = child < 0 ? errno : 0;
  report.close_write_end();
  // The pipe closes without a byte when the child starts to run the program. If that fails, the
  // child writes the error number into the pipe.
  const bool failed = child < 0 || read(report.read_end(), &error, sizeof error) > 0;
  if (failed && child > 0) wait_for(child);
  if (failed) fail("{}: cannot be started ({})", command[0], std::strerror(error));
  return child;
}

}  // namespace

void run_subprocess(const std::vector<std::string>& command, const std::filesystem::path& log) {
  run_unless_excused(command, log, {});
}

bool run_unless_excused(const std::vector<std::string>& command, const std::filesystem::path& log,
                        const std::vector<std::string>& excuses) {
  const int status = wait_for(start(command, log));
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return true;
  const std::string said = read_file(log);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 1)
    for (const std::string& excuse : excuses)
      if (said.find(excuse) != std::string::npos) return false;
  const std::string how = WIFSIGNALED(status) ? fmt::format("signal {}", WTERMSIG(status))
                                              : fmt::format("exit code {}", WEXITSTATUS(status));
  fail("{}: {} (all of its output is in {}): {}", command[0], how, log.string(), last_line(said));
}

std::filesystem::path program_folder() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path();
}

}  // namespace axial
