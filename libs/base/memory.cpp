// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/memory.h"

#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <string>

#include "base/error.h"

namespace axial {
namespace {

namespace fs = std::filesystem;

std::optional<std::uint64_t> first_number(const fs::path& file) {
  std::ifstream in(file);
  std::uint64_t value = 0;
  if (in >> value) return value;
  return {};  // no such file, or "max"
}

std::optional<std::uint64_t> mem_available(const fs::path& root) {
  std::ifstream in(root / "proc/meminfo");
  std::string name, unit;
  std::uint64_t kilobytes = 0;
  while (in >> name >> kilobytes && std::getline(in, unit))
    if (name == "MemAvailable:") return kilobytes * 1024;
  return {};
}

// The lowest limit of a control group and of the groups that contain it. `mount`: the folder of the
// groups' files.
std::uint64_t lowest_limit(const fs::path& mount, fs::path group, const char* file) {
  std::uint64_t lowest = std::numeric_limits<std::uint64_t>::max();
  for (group = group.relative_path();; group = group.parent_path()) {
    lowest = std::min(lowest, first_number(mount / group / file).value_or(lowest));
    if (group.empty()) return lowest;
  }
}

// Lines of /proc/self/cgroup are "4:memory:/group" in version 1 and "0::/group" in version 2.
// Inside a container the line may contain the group's name outside of it; the files of the group
// then lie in the mount folder itself.
std::uint64_t container_limit(const fs::path& root) {
  const fs::path mount = root / "sys/fs/cgroup";
  std::uint64_t lowest = std::min(lowest_limit(mount, {}, "memory.max"),
                                  lowest_limit(mount / "memory", {}, "memory.limit_in_bytes"));
  std::ifstream in(root / "proc/self/cgroup");
  for (std::string line; std::getline(in, line);) {
    const std::size_t name = line.find(':') + 1, group = line.find(':', name) + 1;
    if (name == 0 || group == 0) continue;
    const std::string controllers = line.substr(name, group - 1 - name);
    if (controllers.empty())
      lowest = std::min(lowest, lowest_limit(mount, line.substr(group), "memory.max"));
    else if (controllers == "memory")
      lowest = std::min(
          lowest, lowest_limit(mount / "memory", line.substr(group), "memory.limit_in_bytes"));
  }
  return lowest;
}

}  // namespace

std::uint64_t available_memory(const fs::path& root) {
  const auto available = mem_available(root);
  if (!available) fail_in(root / "proc/meminfo", "has no value MemAvailable");
  return std::min(*available, container_limit(root));
}

std::uint64_t resident_memory() {
  std::ifstream in("/proc/self/statm");
  std::uint64_t total = 0, resident = 0;
  in >> total >> resident;
  return resident * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

std::uint64_t allocated_memory() {
  const auto all = ::mallinfo2();
  return all.uordblks + all.hblkhd;
}

void share_one_heap() {
  ::mallopt(M_ARENA_MAX, 1);
}

void map_large_blocks() {
  ::mallopt(M_MMAP_THRESHOLD, 1 << 20);
  // Setting the first threshold also fixes the second, at a value so small that the heaps would
  // grow and shrink all the time.
  ::mallopt(M_TRIM_THRESHOLD, 16 << 20);
}

void return_freed_memory() {
  ::malloc_trim(0);
}

}  // namespace axial
