// SPDX-License-Identifier: GPL-3.0-or-later
// The maps of MapSurface and CompareSurveys as pictures for the page.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace axial::apps {

struct MapOptions {
  std::filesystem::path maps;     // the begin of the names that MapSurface wrote; empty: none
  std::filesystem::path raw;      // the same for the map with the colours of the photographs
  std::filesystem::path earlier;  // the same for the map of the earlier survey
  std::filesystem::path changes;  // the begin of the names that CompareSurveys wrote; empty: none
  int longest_side = 4096;        // of the pictures [px]

  bool is_empty() const {
    return maps.empty() && raw.empty() && earlier.empty() && changes.empty();
  }
};

// Writes the pictures of all maps and the heights to `staging`. Returns what the page needs to show
// them (page/src/maps.js), or null if there are no maps:
//   "layers": a list of "id", "title", "file", "size" (width and height of the picture [px]),
//     "place" (left, top, width, height [map, m]) and, with colours of values, "legend"
//   "heights": "file", "size", "place", and "low" and "step" of view::height_data(); or null
//   "axes", "offset": those of map::WorldAxes, or null if the files do not state them
//   "change": with changes, the volumes of the comparison and its largest regions
// The axes are those for the world of the later survey, if the comparison aligned it.
// Error that names the file if a file of `options` is missing, malformed, of another kind or
// not of the same map as the others.
nlohmann::ordered_json write_maps(const MapOptions& options, const std::filesystem::path& staging);

}  // namespace axial::apps
