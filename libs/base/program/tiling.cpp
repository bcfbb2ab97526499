// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/program/tiling.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "base/error.h"
#include "base/fraction.h"
#include "base/parse_number.h"
#include "base/program/output_name.h"

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

std::string text_of(const Tiling& tiling) {
  return tiling.tile ? fmt::format("{} {}/{}", setting("tile"), *tiling.tile, tiling.count)
                     : fmt::format("{} {}", setting("tiles"), tiling.count);
}

void check(const Tiling& tiling) {
  const std::size_t tile = tiling.tile.value_or(1);
  if (tiling.count < 1 || tiling.count > kMostTiles || tile < 1 || tile > tiling.count)
    fail("{}: must be from 1 to {}", text_of(tiling), tiling.tile ? tiling.count : kMostTiles);
}

void take_tile(const std::string& value, const ParsedOptions& parsed, Tiling& tiling) {
  const auto [tile, count] = parse_fraction(setting("tile"), value, kMostTiles);
  if (given(parsed, "tiles") && tiling.count != count)
    fail("{} {}: contradicts {}", setting("tile"), value, text_of(Tiling{tiling.count}));
  tiling = {count, tile};
}

fs::path tile_file(const fs::path& output, std::size_t tile, std::size_t tiles,
                   const std::string& extension) {
  return fs::path(output).replace_extension(fmt::format(".tile{}-{}{}", tile, tiles, extension));
}

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

void warn_of_other_tiles(const std::vector<fs::path>& tiles, const Context& context) {
  if (tiles.empty()) return;
  context.warning(
      "{}{}: of another number of tiles, not renewed by this run: remove what is not needed",
      tiles.front().string(),
      tiles.size() == 1 ? "" : fmt::format(" and {} more", tiles.size() - 1));
}

}  // namespace axial
