// SPDX-License-Identifier: GPL-3.0-or-later
// Readers of files as fuzz tests. A reader gets arbitrary bytes. It may refuse the bytes only by an
// axial::Error.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "axial/base.h"
#include "base/atomic_file.h"
#include "base/error.h"

namespace axial::fuzz {

namespace fs = std::filesystem;

struct Reader {
  std::string_view name;  // of the test and of its folder of seeds
  const char* file;       // the name under which the bytes are stored
  // Reads `file` and checks the result. May write other files into the folder of `file`. An Error
  // means that the bytes are refused. Its message must be one line that begins with the name of
  // `file`, or with the name of a file that `file` names.
  void (*read)(const fs::path& file);
  // Writes a valid file as a start for the fuzzer. `variant`: 0, 1, ...: selects the content of the
  // file. Returns false if there is no such variant.
  bool (*write_seed)(const fs::path& file, int variant);
};

// The readers in groups, by format.
std::span<const Reader> camera_readers();
std::span<const Reader> colmap_readers();
std::span<const Reader> control_readers();
std::span<const Reader> dmap_readers();
std::span<const Reader> image_readers();
std::span<const Reader> mvs_readers();
std::span<const Reader> ply_readers();
std::span<const Reader> text_readers();

// Prints `fault` and aborts, so that libFuzzer keeps the input.
[[noreturn]] void report(const std::string& fault);

inline void require(bool good, const std::string& fault) {
  if (!good) report(fault);
}

// For readers that warn: makes the text of each line, and drops it.
inline const Context& dropping_lines() {
  static const Context context([](const Event&) {});
  return context;
}

// Returns the path of a file with the same name in the subfolder "again" of the file's folder.
inline fs::path copy_of(const fs::path& file) {
  return file.parent_path() / "again" / file.filename();
}

// Returns work(). An Error is reported as a fault.
template <class Work>
auto without_error(Work work) {
  try {
    return work();
  } catch (const Error& error) {
    report(std::string("a file was read, but its copy gives: ") + error.what());
  }
}

// Writes `value`, reads it again and returns the result. An Error is a fault.
template <class Value, class Read, class Write>
Value read_copy(const Value& value, const fs::path& file, Read read, Write write) {
  return without_error([&]() -> Value {
    write(copy_of(file), value);
    return read(copy_of(file));
  });
}

// Reads a value from `file`, writes it to a copy, reads the copy, and writes the result again. It
// is a fault if the two written files differ. An Error of the first reading is passed on; a later
// Error is a fault.
template <class Read, class Write>
void read_and_copy(const fs::path& file, Read read, Write write) {
  const auto value = read(file);
  const auto again = read_copy(value, file, read, write);
  const std::string bytes = read_file(copy_of(file));
  without_error([&] { write(copy_of(file), again); });
  require(read_file(copy_of(file)) == bytes, "the copy of a file is read as another value");
}

}  // namespace axial::fuzz
