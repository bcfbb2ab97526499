// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/artifacts/artifact.h"

#include <sys/stat.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/error.h"
#include "io/bytes/json.h"

namespace axial::io {
namespace fs = std::filesystem;

namespace {

constexpr int kMarkVersion = 1;

}  // namespace

fs::path side_file(const fs::path& file) {
  return file.string() + ".json";
}

std::vector<fs::path> with_side_file(const fs::path& file) {
  return {file, side_file(file)};
}

void remove_with_side_file(const fs::path& file) {
  std::error_code ignored;
  for (const fs::path& one : with_side_file(file)) fs::remove(one, ignored);
}

void write_mark(const Artifact& artifact, nlohmann::json facts) {
  facts["version"] = kMarkVersion;
  facts["made_from"] = artifact.made_from;
  facts["content"] = print_of_file(artifact.file);
  write_json(side_file(artifact.file), facts);
}

std::optional<nlohmann::json> read_mark(const fs::path& file) {
  nlohmann::json mark = read_object(side_file(file));
  try {
    if (mark["version"] == kMarkVersion && mark["content"] == print_of_file(file)) return mark;
  } catch (const Error&) {
    // The file is missing or cannot be read.
  }
  return {};
}

std::optional<nlohmann::json> read_mark(const Artifact& artifact) {
  std::optional<nlohmann::json> mark = read_mark(artifact.file);
  if (mark && (*mark)["made_from"] != artifact.made_from) mark.reset();
  return mark;
}

void fill_folder(const Artifact& folder, const std::function<void()>& make) {
  const fs::path mark = folder.file / "made-from.json";
  if (fs::is_regular_file(mark) && read_file(mark) == folder.made_from) return;
  fs::remove_all(folder.file);
  make_folder(folder.file);
  make();
  write_atomically(mark, folder.made_from);
}

std::string print_of_file(const fs::path& file) {
  std::error_code ignored;
  std::ifstream in;
  if (fs::is_regular_file(file, ignored)) in.open(file, std::ios::binary);  // a pipe would wait
  std::string piece(1 << 20, '\0');
  Fingerprint print;
  while (in.is_open() && in) {
    in.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    print.add(std::string_view(piece).substr(0, static_cast<std::size_t>(in.gcount())));
  }
  if (!in.eof()) fail_in(file, "cannot be read");
  return print.hex();
}

bool add_state(Fingerprint& print, const fs::path& file) {
  struct stat found {};
  if (::stat(file.c_str(), &found) != 0) return false;
  for (const auto number : {found.st_size, found.st_mtim.tv_sec, found.st_mtim.tv_nsec})
    print.add(static_cast<std::uint64_t>(number));
  return true;
}

}  // namespace axial::io
