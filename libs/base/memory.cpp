// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/memory.h"

#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
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

}  // namespace

std::uint64_t available_memory(const fs::path& root) {
  const auto available = mem_available(root);
  if (!available)
    fail("{}: says no MemAvailable; give --max-memory", (root / "proc/meminfo").string());
  std::uint64_t bytes = *available;
  for (const char* limit :
       {"sys/fs/cgroup/memory.max", "sys/fs/cgroup/memory/memory.limit_in_bytes"})
    bytes = std::min(bytes, first_number(root / limit).value_or(bytes));
  return bytes;
}

std::uint64_t resident_memory() {
  std::ifstream in("/proc/self/statm");
  std::uint64_t total = 0, resident = 0;
  in >> total >> resident;
  return resident * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

void return_large_blocks_when_freed() {
  // Said explicitly, because otherwise the threshold rises with every large block that is freed.
  constexpr int kLarge = 1 << 20;
  ::mallopt(M_MMAP_THRESHOLD, kLarge);
  ::mallopt(M_TRIM_THRESHOLD, kLarge);
}

}  // namespace axial
