// SPDX-License-Identifier: GPL-3.0-or-later
// Keeps two runs from writing the same output at the same time.
#pragma once

#include <filesystem>
#include <vector>

namespace axial {

// Whether a run writes an output alone, or together with other runs that write other parts of it.
enum class LockUse { alone, shared };

// Whether the folder in which an output lies, and its parents, are made where they are missing. A
// folder that cannot be made gives no Error.
enum class ParentFolder { as_it_is, made };

// Locks an output, a file or a folder, from construction to destruction. Two locks of one output
// exclude each other, unless both are LockUse::shared. Processes lock the file <output>.lock by
// flock(), so that the lock of a killed process ends with the process. The file of a folder lies
// beside the folder, also if `output` ends with a slash. The file holds a line for each process
// that has the lock: its number, its machine, and the time since when. The last process removes the
// file; a file that a killed process left behind is used and removed by the next one. Folders
// that a lock made, and that are empty at its end, are removed: a refused run leaves none.
class OutputLock {
 public:
  // Throws an Error that names `output` and the process that holds the lock if another process, or
  // another object of this process, holds it. Throws an Error that names the file <output>.lock if
  // another program wrote the file; the file stays as it is. If the file system has no locks, or if
  // the folder does not exist or cannot be written, nothing is locked and no Error is thrown.
  explicit OutputLock(std::filesystem::path output, LockUse use = LockUse::alone,
                      ParentFolder parent = ParentFolder::as_it_is);
  ~OutputLock();
  OutputLock(const OutputLock&) = delete;
  OutputLock& operator=(const OutputLock&) = delete;

 private:
  std::filesystem::path file_;
  std::vector<std::filesystem::path> made_;  // folders, the deepest first
  int descriptor_ = -1;                      // below 0: nothing is locked
};

// Locks `output` with ParentFolder::made.
OutputLock lock_output(const std::filesystem::path& output, LockUse use = LockUse::alone);

}  // namespace axial
