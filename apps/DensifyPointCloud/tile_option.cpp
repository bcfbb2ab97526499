// SPDX-License-Identifier: GPL-3.0-or-later
#include "tile_option.h"

#include <fmt/format.h>

#include <optional>
#include <string_view>

#include "base/error.h"
#include "base/parse_number.h"

namespace axial::apps {
namespace {

using densify::Settings;

struct Fraction {
  std::size_t part, count;
};

Fraction parse_tile(const std::string& text) {
  const std::size_t slash = text.find('/');
  const std::string_view all(text);
  const auto part = parse_number<std::size_t>(all.substr(0, slash));
  const auto count =
      slash == std::string::npos ? std::nullopt : parse_number<std::size_t>(all.substr(slash + 1));
  if (!part || !count) fail("--tile {}: must be I/N, for example 2/4", text);
  if (*count < 1 || *count > densify::kMostTiles)
    fail("--tile {}: the number of tiles must be from 1 to {}", text, densify::kMostTiles);
  if (*part < 1 || *part > *count)
    fail("--tile {}: the number of the tile must be from 1 to {}", text, *count);
  return {*part, *count};
}

// Tiles are parts of a fused cloud.
void require_fusion(const std::string& option, const Settings& settings) {
  if (!settings.fuse || only_exports(settings) || !settings.neighbour_lists_output.empty())
    fail("{}: needs fusion, which this run does not make", option);
  if (settings.estimate_colors == 1)
    fail("{}: contradicts --estimate-colors 1, which needs the whole cloud", option);
  if (settings.estimate_normals == 1)
    fail("{}: contradicts --estimate-normals 1, which needs the whole cloud", option);
}

}  // namespace

void take_tiles(const std::string& tile, Options& options) {
  Settings& settings = options.settings;
  if (settings.fusion_tiles < 1 || settings.fusion_tiles > densify::kMostTiles)
    fail("--fusion-tiles {}: must be from 1 to {}", settings.fusion_tiles, densify::kMostTiles);
  if (settings.fusion_tiles > 1)
    require_fusion(fmt::format("--fusion-tiles {}", settings.fusion_tiles), settings);
  if (!given(options.parsed, "tile")) return;
  const auto [part, count] = parse_tile(tile);
  const std::string option = "--tile " + tile;
  if (given(options.parsed, "fusion-tiles") && settings.fusion_tiles != count)
    fail("{}: contradicts --fusion-tiles {}", option, settings.fusion_tiles);
  require_fusion(option, settings);
  if (!settings.pinhole_export.empty())
    fail("{}: contradicts --pinhole-export, which needs the whole cloud", option);
  settings.tile = part;
  settings.fusion_tiles = count;
}

}  // namespace axial::apps
