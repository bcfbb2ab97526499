// SPDX-License-Identifier: GPL-3.0-or-later
#include "photographs.h"

#include <algorithm>

#include "base/error.h"
#include "io/images/photograph_files.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

void add_folder(const fs::path& folder, std::vector<targets::NamedPhotograph>& photographs) {
  for (const fs::path& file : io::photographs_in_folder(folder, true))
    photographs.push_back({file, file.lexically_relative(folder).string()});
}

}  // namespace

std::vector<targets::NamedPhotograph> photographs_of(std::span<const fs::path> input) {
  std::vector<targets::NamedPhotograph> photographs;
  for (const fs::path& path : input) {
    if (!fs::exists(path)) fail_in(path, "does not exist");
    if (fs::is_directory(path))
      add_folder(path, photographs);
    else
      photographs.push_back({path, path.filename().string()});
  }
  std::ranges::sort(photographs, {}, &targets::NamedPhotograph::name);
  const auto same = std::ranges::adjacent_find(photographs, {}, &targets::NamedPhotograph::name);
  if (same != photographs.end())
    fail_in((same + 1)->file, "has the same name as {}", same->file.string());
  return photographs;
}

}  // namespace axial::apps
