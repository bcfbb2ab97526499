// SPDX-License-Identifier: GPL-3.0-or-later
// Fuzz tests of the readers with libFuzzer (CONTRIBUTING.md, "Fuzz tests").
//
//   fuzz_readers --reader=NAME [LIBFUZZER-OPTION...] [FILE-OR-FOLDER...]
//   fuzz_readers --write-seeds=FOLDER NAME...
//
// The second form writes valid files FOLDER/NAME/* for every reader, and their list FOLDER/NAME.txt
// for libFuzzer's option -seed_inputs. It fails unless the names are those of all readers.
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <set>
#include <vector>

#include "reader.h"

namespace axial::fuzz {

void report(const std::string& fault) {
  std::fprintf(stderr, "FAULT: %s\n", fault.c_str());
  std::abort();
}

namespace {

std::vector<Reader> all_readers() {
  std::vector<Reader> all;
  for (const auto& group : {camera_readers(), colmap_readers(), control_readers(), dmap_readers(),
                            image_readers(), mvs_readers(), ply_readers(), text_readers()})
    all.insert(all.end(), group.begin(), group.end());
  return all;
}

// A folder in memory. The next process removes it if this process crashes.
class Folder {
 public:
  Folder() : path_("/dev/shm/axial_fuzz." + std::to_string(::getpid()) + ".tmp") {
    remove_abandoned("/dev/shm", "axial_fuzz");
    make_folder(path_ / "again");
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

void put(const fs::path& file, std::string_view bytes) {
  std::ofstream out(file, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!out.flush()) report("cannot write " + file.string());
}

// The reader that this process tests.
class Test {
 public:
  explicit Test(const Reader& reader) : reader_(reader), file_(folder_.path() / reader.file) {}

  void run(std::string_view bytes) {
    put(file_, bytes);
    try {
      reader_.read(file_);
    } catch (const Error& error) {
      const std::string message = error.what();
      if (!message.starts_with('/') || message.find('\n') != std::string::npos)
        report("the message is not one line that begins with the name of a file: " + message);
    }
  }

 private:
  Reader reader_;
  Folder folder_;
  fs::path file_;
};

void write_seeds(const Reader& reader, const fs::path& folder, const fs::path& staging) {
  fs::remove_all(folder / reader.name);
  make_folder(folder / reader.name);
  std::string list;
  for (int variant = 0; reader.write_seed(staging / reader.file, variant); ++variant) {
    const fs::path seed = fs::absolute(folder / reader.name / std::to_string(variant));
    fs::copy_file(staging / reader.file, seed);
    list += (list.empty() ? "" : ",") + seed.string();
  }
  put(folder / (std::string(reader.name) + ".txt"), list);
}

// `names`: the readers that the caller tests.
void write_all_seeds(const fs::path& folder, std::span<char* const> names) {
  const std::set<std::string_view> tested(names.begin(), names.end());
  require(tested.size() == all_readers().size(), "another number of readers is tested");
  for (const Reader& reader : all_readers()) {
    require(tested.contains(reader.name), std::string(reader.name) + " is not tested");
    const Folder staging;
    write_seeds(reader, folder, staging.path());
  }
}

std::unique_ptr<Test> test_named(std::string_view name) {
  for (const Reader& reader : all_readers())
    if (reader.name == name) return std::make_unique<Test>(reader);
  std::fprintf(stderr, "--reader=NAME is missing or unknown. The readers are:\n");
  for (const Reader& reader : all_readers()) std::fprintf(stderr, "%s\n", reader.name.data());
  std::exit(1);
}

// libFuzzer passes the arguments to one function and the inputs to another one.
std::unique_ptr<Test>& the_test() {
  static std::unique_ptr<Test> test;
  return test;
}

}  // namespace
}  // namespace axial::fuzz

extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments) {
  using namespace axial::fuzz;
  const std::span all(*arguments, static_cast<std::size_t>(*count));
  const std::string_view first = all.size() > 1 ? all[1] : "";
  const std::string_view value = first.substr(std::min(first.find('=') + 1, first.size()));
  if (first.starts_with("--write-seeds=")) {
    write_all_seeds(value, all.subspan(2));
    std::exit(0);
  }
  the_test() = test_named(first.starts_with("--reader=") ? value : "");
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  axial::fuzz::the_test()->run({reinterpret_cast<const char*>(data), size});
  return 0;
}
