// SPDX-License-Identifier: GPL-3.0-or-later
#include "photographs.h"

#include <algorithm>
#include <array>

#include "base/error.h"
#include "base/file_extension.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

bool is_image(const fs::directory_entry& entry) {
  constexpr std::array<std::string_view, 6> kExtensions{".jpg", ".jpeg", ".png",
                                                        ".tif", ".tiff", ".bmp"};
  return entry.is_regular_file() &&
         std::ranges::find(kExtensions, lower_extension(entry.path())) != kExtensions.end();
}

void add_folder(const fs::path& folder, std::vector<NamedPhotograph>& photographs) {
  const std::size_t before = photographs.size();
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (is_image(entry))
      photographs.push_back({entry.path(), entry.path().lexically_relative(folder).string()});
  if (photographs.size() == before) fail("{}: contains no photographs", folder.string());
}

}  // namespace

std::vector<NamedPhotograph> photographs_of(std::span<const fs::path> input) {
  std::vector<NamedPhotograph> photographs;
  for (const fs::path& path : input) {
    if (!fs::exists(path)) fail("{}: does not exist", path.string());
    if (fs::is_directory(path))
      add_folder(path, photographs);
    else
      photographs.push_back({path, path.filename().string()});
  }
  std::ranges::sort(photographs, {}, &NamedPhotograph::name);
  const auto same = std::ranges::adjacent_find(photographs, {}, &NamedPhotograph::name);
  if (same != photographs.end())
    fail("{}: has the same name as {}", (same + 1)->file.string(), same->file.string());
  return photographs;
}

}  // namespace axial::apps
