// SPDX-License-Identifier: GPL-3.0-or-later
#include "tile_option.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/fraction.h"

namespace axial::apps {
namespace {

using densify::Settings;

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
  if (settings.fusion_tiles > 1)
    require_fusion(fmt::format("--fusion-tiles {}", settings.fusion_tiles), settings);
  if (!given(options.parsed, "tile")) return;
  const auto [part, count] = parse_fraction("--tile", tile, densify::kMostTiles);
  const std::string option = "--tile " + tile;
  if (given(options.parsed, "fusion-tiles") && settings.fusion_tiles != count)
    fail("{}: contradicts --fusion-tiles {}", option, settings.fusion_tiles);
  require_fusion(option, settings);
  if (!settings.until.empty() || !settings.plan.empty())
    fail("{}: contradicts --until and --plan, which fuse nothing", option);
  if (!settings.pinhole_export.empty())
    fail("{}: contradicts --pinhole-export, which needs the whole cloud", option);
  settings.tile = part;
  settings.fusion_tiles = count;
}

}  // namespace axial::apps
