// SPDX-License-Identifier: GPL-3.0-or-later
// Wrong input that every reader must survive: truncated files, files with a changed byte, random
// bytes, empty files. In the build with sanitizers, reads out of bounds and absurd allocations make
// the test fail.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <string_view>

#include "base/error.h"
#include "support/empty_folder.h"
#include "support/error_of.h"

namespace axial::test {

inline void put(const std::filesystem::path& path, std::string_view bytes) {
  std::filesystem::remove(path);  // rewriting a file is slow on some file systems
  std::ofstream out(path, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  ASSERT_TRUE(out.flush()) << path;
}

// `text` with its first `from` replaced by `to`.
inline std::string replaced(std::string_view text, const std::string& from, const std::string& to) {
  std::string result(text);
  const std::size_t at = result.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? result : result.replace(at, from.size(), to);
}

// True if `run` throws an Error of one line that names `file`.
template <class Run>
bool fails_naming(const std::filesystem::path& file, Run run) {
  try {
    run();
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find(file.string()), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return true;
  }
  return false;
}

// Returns the message of the Error that `run` throws, and checks that it names `file`.
template <class Run>
std::string error_naming(const std::filesystem::path& file, Run run) {
  const std::string message = error_of(run);
  EXPECT_NE(message.find(file.string()), std::string::npos) << message;
  return message;
}

// Checks that a reader refuses the beginnings of the valid file `bytes` with a length of 0 to
// bytes.size() - 1 bytes. Beginnings of `first_valid` or more bytes are not checked.
template <class Read>
void expect_prefixes_refused(const std::filesystem::path& file, std::string_view bytes, Read read,
                             std::size_t first_valid = std::string_view::npos) {
  for (std::size_t size = 0; size < std::min(bytes.size(), first_valid); ++size) {
    put(file, bytes.substr(0, size));
    EXPECT_TRUE(fails_naming(file, [&] { read(file); })) << "prefix of " << size << " bytes";
  }
  put(file, bytes);
  EXPECT_FALSE(fails_naming(file, [&] { read(file); })) << "the whole file";
}

// Checks that a reader reads or refuses damaged files without a crash, and refuses at least a few
// of them. The files are the valid file `bytes` with one changed byte, random bytes alone, and
// random bytes after the first `kept` bytes of the valid file.
template <class Read>
void expect_damage_survived(const std::filesystem::path& file, const std::string& bytes, Read read,
                            std::size_t kept = 4, int rounds = 400) {
  std::mt19937 random(20240607);
  int refused = 0;
  for (int i = 0; i < rounds; ++i) {
    std::string damaged = bytes;
    damaged[random() % damaged.size()] ^= static_cast<char>(1 + random() % 255);
    put(file, damaged);
    refused += fails_naming(file, [&] { read(file); });
  }
  for (int i = 0; i < rounds / 4; ++i) {
    std::string garbage = bytes.substr(0, i % 2 ? kept : 0);
    for (std::size_t size = random() % 200; size > 0; --size)
      garbage.push_back(static_cast<char>(random()));
    put(file, garbage);
    refused += fails_naming(file, [&] { read(file); });
  }
  EXPECT_GT(refused, rounds / 10);
}

}  // namespace axial::test
