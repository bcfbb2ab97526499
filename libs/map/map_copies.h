// SPDX-License-Identifier: GPL-3.0-or-later
// Copies of maps in the formats that other programs need, and of other widths.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <vector>

#include "axial/map.h"

namespace axial::map {

// gis: Cloud Optimized GeoTIFF, as the maps themselves, so that there is no copy of the same width.
// taglab: GeoTIFF in tiles, compressed by LZW without predictor, orthomosaic and heights alone.
// archive: GeoTIFF in tiles, compressed by DEFLATE, with a world file (.tfw), of all maps.
enum class Preset { gis, taglab, archive };

// TagLab reads pictures with at most this number of pixels along a side.
inline constexpr int kMostOfTagLab = 32767;

struct CopyOptions {
  Preset preset = Preset::gis;
  std::vector<int> widths = {};  // of further copies of orthomosaic and heights [px]
  int most = kMostOfTagLab;      // pixels along a side of a block of the preset taglab
  int overlap = 512;             // of neighbouring blocks [px]; below `most`
};

// The blocks of a map, row by row. Each has at most `most` pixels along a side. A map that is
// larger is divided into as few rows and columns of blocks as possible, of the same size up to a
// pixel, and neighbours share `overlap` pixels or more.
struct CopyBlock {
  int row = 0, column = 0;  // from 1
  cv::Rect pixels;
};
std::vector<CopyBlock> blocks_of(cv::Size size, int most, int overlap);

// The size of a copy with `width` columns. Its pixels are square: the last row may reach beyond the
// map by a part of a pixel. Its values are means of about the part on the map.
cv::Size size_of_copy(const MapGrid& grid, int width);

// Error that names the setting "widths" for a width above that of the map, because its pixels would
// show nothing new. The message tells a ground sample distance that gives the width.
void require_widths(const CopyOptions& options, const MapGrid& grid);

// The copies of `maps`, whose names begin with `output`: <output>[.<preset>].<map>[_<width>]
// [_r<row>_c<column>].tif. A block has its row and column in its name if there are several. The
// pixels of a copy of another width are means of the pixels with surface that they cover, or that
// are not transparent, weighted by area; its transparency is the mean. A copy states the metadata
// of its map, and as kCopyItem (map/stated_kind.h) the name of the map. Copies are made strip by
// strip. FurtherFiles::write throws an Error that names a file that cannot be read or written.
std::vector<FurtherFiles> copies_of(const MapFiles& maps, const MapGrid& grid,
                                    const std::filesystem::path& output,
                                    const CopyOptions& options);

}  // namespace axial::map
