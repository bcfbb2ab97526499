// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/atomic_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"

namespace axial {
namespace {

namespace fs = std::filesystem;

std::size_t files_in(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(AtomicFile, KeepsTheOldContentsWhenTheWriterFails) {
  const fs::path folder = fs::path(testing::TempDir()) / "atomic_file_keeps";
  fs::create_directories(folder);
  const fs::path file = folder / "a.txt";
  write_atomically(file, "old");
  EXPECT_THROW(write_atomically(file,
                                [](const fs::path& temporary) {
                                  write_atomically(temporary, "half");
                                  fail("no more ink");
                                }),
               Error);
  EXPECT_EQ(read_file(file), "old");
  EXPECT_EQ(files_in(folder), 1u);
  fs::remove_all(folder);
}

TEST(AtomicFile, NamesTheFileThatCannotBeWritten) {
  try {
    write_atomically("/no/such/folder/a.txt", "x");
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("/no/such/folder/a.txt"));
  }
}

TEST(AtomicFile, ReportsAFullDisk) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const fs::path folder = fs::path(testing::TempDir()) / "atomic_file_full";
  fs::create_directories(folder);
  EXPECT_THROW(write_atomically(folder / "a.txt",
                                [](const fs::path& temporary) {
                                  fs::create_symlink("/dev/full", temporary);
                                  write_atomically(temporary / "x", "y");
                                }),
               Error);
  EXPECT_EQ(files_in(folder), 0u);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace axial
