// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a map reduced, so that the memory does not depend on the size of the file.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "map/geotiff.h"
#include "map/world_axes.h"

namespace axial::map {

// A map that was reduced while it was read.
struct ReducedMap {
  MapGrid grid;                   // of the whole map in the file
  std::optional<WorldAxes> axes;  // empty: the file does not state them
  // R G B alpha (CV_8UC4) of a map of colours. Otherwise CV_32FC1: NaN where the map has no finite
  // value.
  cv::Mat pixels;

  // The grid of `pixels`: it covers the same ground as `grid`, and its pixels may be wider than
  // high by a rounding to whole pixels.
  double pixel_width() const { return grid.columns * grid.pixel / pixels.cols; }
  double pixel_height() const { return grid.rows * grid.pixel / pixels.rows; }
};

// Reads the map at `path`. If a side has more than `longest_side` pixels, the map is reduced so
// that its longest side has `longest_side` pixels. A reduced pixel is the mean of those pixels of
// its area that have a value, or that are not transparent. If the file has reduced copies, the mean
// is that of the pixels of the next larger copy. Classes are those of single pixels.
//
// Error that names the file if it cannot be read, if it does not state the kind `stated`
// (map/stated_kind.h; empty: any or none), if its bands are not those of `kind`, and if its
// geotransform is not that of a map with square pixels whose y axis points upwards, as those of
// GeoTiff.
ReducedMap read_reduced_map(const std::filesystem::path& path, MapKind kind, int longest_side,
                            const std::string& stated = {});

}  // namespace axial::map
