// SPDX-License-Identifier: GPL-3.0-or-later
// Maps as GeoTIFF files. GDAL writes them. Its headers are not included here.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "map/frame.h"
#include "map/world_axes.h"

namespace axial::map {

// What the pixels of a map are.
enum class MapKind {
  heights,  // one band of float [m], also for errors of heights; kNoHeight: no surface
  colors,   // bands red, green, blue and alpha of 8 bits; alpha 0: no colour
  counts,   // one band of 16 bits; kNoCount: no surface
  shades,   // one band of 8 bits, grey; 0: no surface
  classes   // one band of 8 bits, numbers of classes; kNoClass: none
};

inline constexpr std::uint16_t kNoCount = 65535;
inline constexpr std::uint8_t kNoClass = 255;

// The memory [bytes] that GDAL keeps for blocks of all open files. It is the same for all maps.
inline constexpr std::uint64_t kCacheBytes = 64'000'000;

// A map that is written block by block. The blocks go into a second file beside the map, whose name
// ends in ".blocks.tif". finish() makes the map from it: a Cloud Optimized GeoTIFF in tiles of 512
// x 512 pixels, compressed by DEFLATE, with reduced copies (overviews) of half the size and so on.
// Reduced heights, colours and shades are means of the pixels with surface; reduced counts and
// classes are those of single pixels.
// Files larger than 4 GB become BigTIFF. The file holds no date: the same pixels give the same
// bytes, in whichever order the blocks were written. The destructor removes the second file.
//
// All errors name the map `path`. The functions are not thread-safe.
class GeoTiff {
 public:
  // `path`: the file to write. `crs`: the coordinate reference system as WKT; empty: none. The
  // geotransform of the file has the upper left corner of `grid` (not the centre of the pixel).
  GeoTiff(const std::filesystem::path& path, MapKind kind, const MapGrid& grid,
          const std::string& crs);
  ~GeoTiff();
  GeoTiff(const GeoTiff&) = delete;
  GeoTiff& operator=(const GeoTiff&) = delete;

  // States the axes of the map in the file, as the metadata items AXIALMVS_AXES and AXIALMVS_OFFSET
  // (docs/maps.md). Without this call the file does not state them.
  void state_axes(const WorldAxes& axes);

  // States what the map shows: the metadata item AXIALMVS_KIND, with a value of map/stated_kind.h.
  // Without this call the file does not state it.
  void state_kind(const std::string& kind);

  // Writes the pixels `at` of the map. The type of `pixels` is that of the kind: CV_32FC1, CV_8UC4
  // (R G B alpha), CV_16UC1 or CV_8UC1. Pixels that are never written have no surface.
  void write(const cv::Rect& at, const cv::Mat& pixels);

  // Writes the map.
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// A map that was read from a file.
struct StoredMap {
  MapGrid grid;
  std::string crs;                 // WKT; empty: none
  std::optional<double> no_value;  // the value of pixels without surface, if the file states it
  // All pixels, or all pixels of the map reduced to the requested size. The channels are those of
  // MapKind.
  cv::Mat pixels;
};

// The size of a map whose longest side is reduced to at most `longest_side` pixels. Pixels stay
// square up to half a pixel of the longer side, also where the shorter side has few pixels: the
// longest side is then up to half as long. Exception: the shorter side keeps one pixel if the map
// is longer than wide by more than the factor `longest_side`.
cv::Size reduced_size(const MapGrid& grid, int longest_side);

// Reads a map that GeoTiff wrote. If a side has more than `longest_side` pixels, the map is reduced
// to reduced_size(); the colours are then averaged, and heights
// and counts are those of single pixels. `grid` is that of the whole map. Error that names the file
// if it cannot be read.
StoredMap read_map(const std::filesystem::path& path, int longest_side = 1 << 30);

}  // namespace axial::map
