// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/images/folder_ends.h"

#include <algorithm>
#include <system_error>

namespace axial::io {

namespace fs = std::filesystem;

std::vector<fs::path> folder_ends(const fs::path& folder, const fs::path& of) {
  std::vector<fs::path> ends{""};
  fs::path end;
  const fs::path relative = of.relative_path();
  const std::vector<fs::path> parts(relative.begin(), relative.end());
  for (auto part = parts.rbegin(); part != parts.rend(); ++part) {
    end = end.empty() ? *part : *part / end;
    std::error_code error;
    if (fs::is_directory(folder / end, error)) ends.push_back(end);
  }
  std::ranges::reverse(ends);
  return ends;
}

}  // namespace axial::io
