// SPDX-License-Identifier: GPL-3.0-or-later
// Makes the maps of a mesh and writes them to files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/context.h"
#include "base/setting_names.h"
#include "map/map_block.h"
#include "scene/local_frame.h"

namespace axial::map {

// The files to write. An empty path: the file is not written.
struct MapFiles {
  std::filesystem::path heights;   // GeoTIFF (MapKind::heights)
  std::filesystem::path colors;    // GeoTIFF (MapKind::colors); needs textures
  std::filesystem::path counts;    // GeoTIFF (MapKind::counts); needs MapContent::views
  std::filesystem::path errors;    // GeoTIFF (MapKind::heights); needs MapContent::errors
  std::filesystem::path shades;    // GeoTIFF (MapKind::shades)
  std::filesystem::path contours;  // GeoJSON of write_contours(); needs `heights`
  std::filesystem::path picture;   // JPEG of draw_overview(); needs `colors`

  // The files with a path, in the order of the members.
  std::vector<std::filesystem::path> all() const;
};

struct WriteOptions {
  std::string crs = {};           // WKT; empty: none
  bool is_georeferenced = false;  // y of the map is north, for the arrow in the picture
  LocalFrame mesh_frame = {};     // for the axes that the files state
  int block_size = 512;           // [px]; affects the memory, but not the result
  int samples = 0;                // along each side of a pixel, odd; 0: samples_per_pixel()
  double contour_interval = 0;    // height between contour lines [m]
  int longest_side = 2048;        // of the picture, without its strip [px]
  // Errors name the field contour_interval by name_of("contour_interval").
  SettingNames name_of = own_name;
};

struct MapReport {
  std::int64_t surface = 0;  // pixels with a height
  std::int64_t colored = 0;  // pixels with a colour
};

// Makes the maps of `content` block by block, several at the same time, and writes them. All files
// are written under temporary names and then renamed one after the other. If anything fails before
// that, existing files keep their content. The result has the same bytes for any number of threads,
// any size of blocks and any memory. The stages "Maps" and "Files" count blocks and files.
//
// Errors of check_content() are passed on. Error that names the file if it cannot be written, and
// if the memory does not suffice for samples_per_pixel(), and for the lists of faces and one block.
MapReport write_maps(const MapFiles& files, const MapContent& content, const WriteOptions& options,
                     const Context& context = {});

}  // namespace axial::map
