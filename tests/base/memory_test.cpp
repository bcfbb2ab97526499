// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/memory.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "axial/base.h"
#include "base/error.h"
#include "support/empty_folder.h"
#include "support/error_of.h"

namespace axial {
namespace {

namespace fs = std::filesystem;

// A fake root folder with files of /proc and /sys.
class FakeSystem {
 public:
  FakeSystem() = default;
  ~FakeSystem() { fs::remove_all(root_); }
  FakeSystem(const FakeSystem&) = delete;

  FakeSystem& says(const fs::path& file, const std::string& text) {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text;
    return *this;
  }
  std::uint64_t available() const { return available_memory(root_); }

 private:
  fs::path root_ = test::empty_folder();
};

const std::string kMeminfo =
    "MemTotal:       24684040 kB\nMemFree:          100000 kB\nMemAvailable:    3000000 kB\n"
    "Buffers:               0 kB\n";

TEST(AvailableMemory, IsWhatTheSystemSays) {
  FakeSystem system;
  system.says("proc/meminfo", kMeminfo);
  EXPECT_EQ(system.available(), 3000000u * 1024);
}

TEST(AvailableMemory, IsTheContainersLimitWhereThatIsLower) {
  for (const char* file :
       {"sys/fs/cgroup/memory.max", "sys/fs/cgroup/memory/memory.limit_in_bytes"}) {
    FakeSystem system;
    system.says("proc/meminfo", kMeminfo).says(file, "1000000\n");
    EXPECT_EQ(system.available(), 1000000u);
    system.says(file, "9223372036854771712\n");
    EXPECT_EQ(system.available(), 3000000u * 1024);
    system.says(file, "max\n");
    EXPECT_EQ(system.available(), 3000000u * 1024);
  }
}

TEST(AvailableMemory, KnowsTheLimitsOfNestedContainers) {
  for (const char* groups : {"9:cpu:/x\n4:memory:/outer/inner\n", "0::/outer/inner\n"}) {
    const bool first = groups[0] == '9';
    const fs::path mount = first ? "sys/fs/cgroup/memory" : "sys/fs/cgroup";
    const char* file = first ? "memory.limit_in_bytes" : "memory.max";
    FakeSystem system;
    system.says("proc/meminfo", kMeminfo).says("proc/self/cgroup", groups);
    system.says(mount / "outer" / "inner" / file, "2000000\n");
    EXPECT_EQ(system.available(), 2000000u);
    system.says(mount / "outer" / file, "1500000\n");
    EXPECT_EQ(system.available(), 1500000u);
    system.says(mount / "other" / file, "1000\n");
    EXPECT_EQ(system.available(), 1500000u);
  }
}

TEST(AvailableMemory, NamesTheFileThatDoesNotSay) {
  FakeSystem system;
  system.says("proc/meminfo", "MemTotal: 5 kB\n");
  EXPECT_THROW(system.available(), Error);
}

TEST(ResidentMemory, RisesAndFallsWithLargeBlocks) {
#ifdef AXIAL_SANITIZED
  GTEST_SKIP() << "the sanitizer keeps freed blocks to itself";
#endif
  constexpr std::size_t kBytes = 64 << 20;
  const std::uint64_t before = resident_memory();
  {
    const std::vector<char> block(kBytes, 1);
    EXPECT_GT(resident_memory(), before + kBytes / 2 + static_cast<std::size_t>(block[7]));
  }
  EXPECT_LT(resident_memory(), before + kBytes / 2);
}

TEST(AllocatedMemory, CountsWhatIsHeldAndNothingElse) {
#ifdef AXIAL_SANITIZED
  GTEST_SKIP() << "the sanitizer's allocator is not the C library's";
#endif
  constexpr std::size_t kSmall = 16 << 10;  // small freed blocks may be kept, and then still count
  for (const std::size_t bytes : {std::size_t{100} << 10, std::size_t{64} << 20}) {
    const std::uint64_t before = allocated_memory();
    {
      const std::vector<char> block(bytes);
      EXPECT_GE(allocated_memory(), before + bytes);
      EXPECT_LT(allocated_memory(), before + bytes + kSmall);
    }
    EXPECT_LT(allocated_memory(), before + kSmall);
  }
}

TEST(MemoryBudget, OfAProgramCountsAtLeastTheProgramItself) {
  constexpr std::uint64_t kProgram = 1'000'000 * kMegabyte;  // more than this process uses
  const auto budget = MemoryBudget::of_program(1'000'010, kProgram);
  EXPECT_EQ(budget.left(), 10 * kMegabyte);
  EXPECT_NO_THROW(budget.require(10 * kMegabyte, "reading a.ply"));
  EXPECT_EQ(test::error_of([&] { budget.require(10 * kMegabyte + 1, "reading a.ply"); }),
            "max_memory: 1000010 MB are too little, reading a.ply needs 1000011 MB");
  EXPECT_EQ(MemoryBudget::of_program(999'999, kProgram).left(), 0u);
}

TEST(MemoryBudget, OfAProgramCountsWhatTheProcessUses) {
  const auto tiny = MemoryBudget::of_program(1, 0);  // less than this process uses
  EXPECT_EQ(tiny.left(), 0u);
  EXPECT_THROW(tiny.require(0, "work"), Error);
  const std::uint64_t used = resident_memory();
  const auto budget = MemoryBudget::of_program(used / kMegabyte + 100, 0);
  constexpr std::uint64_t kSlack = 20 * kMegabyte;  // what the process uses changes a little
  EXPECT_NEAR(static_cast<double>(budget.left()), 100.0 * kMegabyte, static_cast<double>(kSlack));
  EXPECT_NO_THROW(budget.require(100 * kMegabyte - kSlack, "work"));
  EXPECT_THROW(budget.require(100 * kMegabyte + kSlack, "work"), Error);
}

TEST(MemoryBudget, CountsReservationsWhileTheyLive) {
  const auto budget = MemoryBudget::of_bytes(10 * kMegabyte);
  const MemoryBudget copy = budget.with_advice("; use less");
  {
    const auto first = budget.reserve(4 * kMegabyte, "a list");
    auto second = copy.reserve(3 * kMegabyte);
    EXPECT_EQ(budget.left(), 3 * kMegabyte);
    second = copy.reserve(1 * kMegabyte);
    EXPECT_EQ(copy.share().items(2 * kMegabyte, 9, "work"), 2u);
    EXPECT_EQ(copy.items(1, 9, "work"), 9u);
    EXPECT_EQ(test::error_of([&] { copy.require(6 * kMegabyte, "a tree"); }),
              "max_memory: a tree needs 2 MB more; use less");
    const auto more = budget.reserve(9 * kMegabyte);
    EXPECT_EQ(budget.left(), 0u);
  }
  EXPECT_EQ(budget.left(), 10 * kMegabyte);
}

TEST(MemoryBudget, AShareDoesNotCountTheProcess) {
  const auto whole = MemoryBudget::of_program(1'000'010, 1'000'000 * kMegabyte);
  const auto taken = whole.reserve(4 * kMegabyte);
  const MemoryBudget share = whole.share();
  EXPECT_EQ(share.left(), 6 * kMegabyte);
  const auto all = share.reserve(6 * kMegabyte, "work");
  EXPECT_EQ(share.left(), 0u);
  EXPECT_EQ(whole.left(), 6 * kMegabyte);
}

TEST(MemoryBudget, WithoutALimitAllowsEverything) {
  const MemoryBudget budget;
  const auto much = budget.reserve(UINT64_MAX / 2, "work");
  EXPECT_NO_THROW(budget.require(UINT64_MAX, "work"));
  EXPECT_EQ(budget.left(), UINT64_MAX);
  EXPECT_EQ(budget.items(UINT64_MAX / 4, 9, "work"), 4u);
}

// Other blocks lie between the large ones, so that a heap could not shrink.
TEST(MapLargeBlocks, ReturnsEachWhenItIsFreed) {
#ifdef AXIAL_SANITIZED
  GTEST_SKIP() << "the sanitizer keeps freed blocks to itself";
#endif
  map_large_blocks();
  constexpr std::size_t kBlocks = 32, kBytes = 2 << 20, kBetween = 64 << 10;
  // By default, freeing a block of this size makes the C library take the next blocks from the
  // heap.
  { const std::vector<char> block(16 << 20, 1); }
  std::vector<std::unique_ptr<char[]>> large, between;
  for (std::size_t i = 0; i < kBlocks; ++i) {
    large.push_back(std::make_unique<char[]>(kBytes));
    std::fill_n(large.back().get(), kBytes, static_cast<char>(i));
    between.push_back(std::make_unique<char[]>(kBetween));
  }
  const std::uint64_t before = resident_memory();
  large.resize(1);
  EXPECT_LT(resident_memory(), before - (kBlocks - 2) * kBytes);
}

// The other thread keeps its last block, which lies at the top of the heap. If that thread had a
// heap of its own, this heap could not shrink.
TEST(ShareOneHeap, ServesOneThreadFromWhatAnotherHasFreed) {
#ifdef AXIAL_SANITIZED
  GTEST_SKIP() << "the sanitizer's allocator is not the C library's";
#endif
  share_one_heap();
  constexpr std::size_t kBlocks = 1000, kBytes = 64 << 10;
  const auto take = [] {
    std::vector<std::unique_ptr<char[]>> blocks;
    for (std::size_t i = 0; i < kBlocks; ++i) {
      blocks.push_back(std::make_unique<char[]>(kBytes));
      std::fill_n(blocks.back().get(), kBytes, static_cast<char>(i));
    }
    return blocks;
  };
  std::unique_ptr<char[]> kept;
  std::thread([&] { kept = std::move(take().back()); }).join();
  const std::uint64_t before = resident_memory();
  const auto blocks = take();
  EXPECT_LT(resident_memory(), before + kBlocks / 4 * kBytes);
}

// Every second one of many small blocks is freed. The C library would keep the freed blocks.
TEST(ReturnFreedMemory, LetsGoOfWhatWasFreed) {
#ifdef AXIAL_SANITIZED
  GTEST_SKIP() << "the sanitizer keeps freed blocks to itself";
#endif
  constexpr std::size_t kBlocks = 2000, kBytes = 64 << 10;
  std::vector<std::unique_ptr<char[]>> blocks;
  for (std::size_t i = 0; i < kBlocks; ++i) {
    blocks.push_back(std::make_unique<char[]>(kBytes));
    std::fill_n(blocks.back().get(), kBytes, static_cast<char>(i));
  }
  for (std::size_t i = 0; i < kBlocks; i += 2) blocks[i].reset();
  const std::uint64_t before = resident_memory();
  return_freed_memory();
  EXPECT_LT(resident_memory(), before - kBlocks / 2 * kBytes / 2);
}

}  // namespace
}  // namespace axial
