// SPDX-License-Identifier: GPL-3.0-or-later
// The description of maps for an archive, as XML.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "axial/map.h"

namespace axial::map {

// What the maps themselves do not state.
struct ArchiveFacts {
  std::string title;    // of the survey
  std::string program;  // with its version
  // Of the photographs: a kind of port, in words, and how many have it.
  std::vector<std::pair<std::string, std::size_t>> ports = {};
  std::vector<std::pair<std::string, std::filesystem::path>> inputs = {};  // role and file
  double image_noise = 0;  // for MapFiles::errors [px]
};

// Writes `path` in place, in UTF-8: title, program, inputs (names without folders), ports,
// reference system, resolution, extent and axes of the maps `maps` of MapSurface, the heights'
// expected errors (docs/formats.md), and the names `files`. It holds no date, so that the same maps
// give the same bytes. Needs MapFiles::heights. Error that names the file that cannot be read or
// written.
void write_archive_description(const MapFiles& maps, const ArchiveFacts& facts,
                               const std::vector<std::filesystem::path>& files,
                               const std::filesystem::path& path);

}  // namespace axial::map
