// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/other_tiles.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

#include "base/log.h"
#include "base/output_name.h"
#include "base/parse_number.h"

namespace axial {
namespace {

namespace fs = std::filesystem;

// The number of tiles N in a name that ends in ".tileI-N" after `stem`; empty for another name.
std::optional<std::size_t> tiles_in_name(std::string_view name, const std::string& stem) {
  const std::string begin = stem + ".tile";
  if (!name.starts_with(begin)) return {};
  name.remove_prefix(begin.size());
  const std::size_t dash = name.find('-');
  if (dash == std::string_view::npos || !parse_number<std::size_t>(name.substr(0, dash))) return {};
  return parse_number<std::size_t>(name.substr(dash + 1));
}

}  // namespace

std::vector<fs::path> other_tiles(const fs::path& output, std::size_t tiles) {
  const std::string stem = without_known_extension(output).filename().string();
  std::vector<fs::path> others;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(output.parent_path(), ignored)) {
    const fs::path name = entry.path().filename();
    if (known_extension(name).empty()) continue;
    const auto count = tiles_in_name(without_known_extension(name).string(), stem);
    if (count && *count != tiles) others.push_back(output.parent_path() / name);
  }
  std::ranges::sort(others);
  return others;
}

void warn_of_other_tiles(const std::vector<fs::path>& tiles) {
  if (tiles.empty()) return;
  log_warning(
      "{}{}: of another number of tiles, not renewed by this run: remove what is not needed",
      tiles.front().string(),
      tiles.size() == 1 ? "" : fmt::format(" and {} more", tiles.size() - 1));
}

}  // namespace axial
