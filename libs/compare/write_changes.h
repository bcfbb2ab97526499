// SPDX-License-Identifier: GPL-3.0-or-later
// Writes what changed between two surveys to files.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "axial/compare.h"
#include "compare/target_registration.h"
#include "scene/local_frame.h"

namespace axial::compare {

struct ChangeFiles {
  std::filesystem::path difference;   // GeoTIFF (map::MapKind::heights) [m]
  std::filesystem::path significant;  // GeoTIFF (map::MapKind::classes)
  std::filesystem::path sigma;        // GeoTIFF (map::MapKind::heights) [m]
  std::filesystem::path report;       // to_json()
  std::filesystem::path picture;      // JPEG of draw_changes()

  // The files, in the order of the members.
  std::vector<std::filesystem::path> all() const {
    return {difference, significant, sigma, report, picture};
  }
};

struct ChangeFacts {
  std::string before, after;      // names of the surveys
  bool is_georeferenced = false;  // y of the map is north
  bool aligned = false;           // the surveys were registered
  // The registration, if it is one by targets, and the labels of these targets.
  std::optional<TargetRegistration> by_targets = {};
  std::vector<std::string> labels = {};
  std::string crs = {};        // WKT; empty: none
  LocalFrame mesh_frame = {};  // of the surveys, for the axes that the maps state
};

// All numbers of a comparison. docs/compare.md describes the fields.
nlohmann::ordered_json to_json(const Comparison& comparison, const ChangeFacts& facts);

// Writes all files under temporary names and then renames them. If anything fails before that,
// existing files keep their content. The same comparison gives the same bytes. Error that names the
// file that cannot be written.
void write_changes(const ChangeFiles& files, const Comparison& comparison,
                   const ChangeFacts& facts);

}  // namespace axial::compare
