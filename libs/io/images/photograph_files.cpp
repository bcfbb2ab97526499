// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/images/photograph_files.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "base/error.h"
#include "base/file_extension.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;

bool is_photograph(const fs::directory_entry& entry) {
  constexpr std::array<std::string_view, 6> kExtensions{".jpg", ".jpeg", ".png",
                                                        ".tif", ".tiff", ".bmp"};
  return entry.is_regular_file() && !entry.path().filename().string().starts_with('.') &&
         std::ranges::find(kExtensions, lower_extension(entry.path())) != kExtensions.end();
}

template <class Iterator>
void add_photographs(Iterator entries, std::vector<fs::path>& photographs) {
  for (const fs::directory_entry& entry : entries)
    if (is_photograph(entry)) photographs.push_back(entry.path());
}

}  // namespace

std::vector<fs::path> photographs_in_folder(const fs::path& folder, bool with_subfolders) {
  std::vector<fs::path> photographs;
  if (with_subfolders)
    add_photographs(fs::recursive_directory_iterator(folder), photographs);
  else
    add_photographs(fs::directory_iterator(folder), photographs);
  std::ranges::sort(photographs);
  if (photographs.empty()) fail_in(folder, "contains no photographs");
  return photographs;
}

}  // namespace axial::io
