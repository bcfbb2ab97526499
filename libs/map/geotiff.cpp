// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/geotiff.h"

#include <ogr_srs_api.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"
#include "map/stated_kind.h"
#include "private/gdal_calls.h"
#include "private/map_metadata.h"

namespace axial::map {
namespace {

namespace fs = std::filesystem;

constexpr int kTile = 512;

struct KindFacts {
  GDALDataType type;
  int bands, cv_type;
  std::optional<double> no_value;
  const char* averaging;  // of reduced copies
};

KindFacts facts_of(MapKind kind) {
  switch (kind) {
    case MapKind::heights:
      return {GDT_Float32, 1, CV_32FC1, kNoHeight, "AVERAGE"};
    case MapKind::colors:
      return {GDT_Byte, 4, CV_8UC4, {}, "AVERAGE"};
    case MapKind::counts:
      return {GDT_UInt16, 1, CV_16UC1, kNoCount, "NEAREST"};
    case MapKind::classes:
      return {GDT_Byte, 1, CV_8UC1, kNoClass, "NEAREST"};
    case MapKind::shades:
      break;
  }
  return {GDT_Byte, 1, CV_8UC1, 0, "AVERAGE"};
}

// The file beside `path` that gets the blocks.
fs::path blocks_beside(fs::path path) {
  return path.replace_extension(".blocks.tif");
}

void set_georeference(GDALDatasetH file, const MapGrid& grid, const std::string& crs) {
  std::array<double, 6> transform{grid.left, grid.pixel, 0, grid.top, 0, -grid.pixel};
  GDALSetGeoTransform(file, transform.data());
  if (!crs.empty()) GDALSetProjection(file, crs.c_str());
}

// Factors of the reduced copies: halves until the longest side fits one tile.
std::vector<int> reductions(const MapGrid& grid) {
  std::vector<int> factors;
  const int longest = std::max(grid.columns, grid.rows);
  for (int factor = 2; longest > kTile * (factor / 2); factor *= 2) factors.push_back(factor);
  return factors;
}

}  // namespace

struct GeoTiff::State {
  State(const fs::path& map, MapKind kind, const MapGrid& map_grid)
      : path(map), facts(facts_of(kind)), grid(map_grid), blocks(blocks_beside(map)) {}

  fs::path path;
  KindFacts facts;
  MapGrid grid;
  AtomicFile blocks;
  DatasetPtr file;
};

GeoTiff::GeoTiff(const fs::path& path, MapKind kind, const MapGrid& grid, const std::string& crs)
    : state_(std::make_unique<State>(path, kind, grid)) {
  State& s = *state_;
  const GdalErrors errors;
  const GdalOptions options{{"TILED", "YES"},
                            {"BLOCKXSIZE", "512"},
                            {"BLOCKYSIZE", "512"},
                            {"COMPRESS", "DEFLATE"},
                            {"ZLEVEL", "1"},
                            {"PREDICTOR", s.facts.type == GDT_Float32 ? "3" : "2"},
                            {"SPARSE_OK", "TRUE"},
                            {"BIGTIFF", "YES"},
                            {"INTERLEAVE", "PIXEL"},
                            {"ALPHA", "YES"},
                            {"PHOTOMETRIC", s.facts.bands == 4 ? "RGB" : "MINISBLACK"}};
  s.file.reset(GDALCreate(GDALGetDriverByName("GTiff"), s.blocks.temporary().c_str(), grid.columns,
                          grid.rows, s.facts.bands, s.facts.type, options.list()));
  errors.require_written(s.file != nullptr, s.path);
  set_georeference(s.file.get(), grid, crs);
  for (int band = 1; band <= s.facts.bands && s.facts.no_value; ++band)
    GDALSetRasterNoDataValue(GDALGetRasterBand(s.file.get(), band), *s.facts.no_value);
  errors.require_written(true, s.path);
}

GeoTiff::~GeoTiff() {
  const GdalErrors unreported;  // without finish() the blocks are not needed
  state_.reset();
}

void GeoTiff::state_axes(const WorldAxes& axes) {
  const GdalErrors errors;
  map::state_axes(state_->file.get(), axes);
  errors.require_written(true, state_->path);
}

void GeoTiff::state_kind(const std::string& kind) {
  const GdalErrors errors;
  GDALSetMetadataItem(state_->file.get(), kKindItem, kind.c_str(), nullptr);
  errors.require_written(true, state_->path);
}

void GeoTiff::write(const cv::Rect& at, const cv::Mat& pixels) {
  State& s = *state_;
  if (pixels.type() != s.facts.cv_type || pixels.size() != at.size())
    fail_in(s.path, "a block has the wrong type or size");
  const GdalErrors errors;
  const auto bytes = static_cast<GSpacing>(pixels.elemSize1());
  const CPLErr done = GDALDatasetRasterIOEx(s.file.get(), GF_Write, at.x, at.y, at.width, at.height,
                                            pixels.data, at.width, at.height, s.facts.type,
                                            s.facts.bands, nullptr, bytes * s.facts.bands,
                                            static_cast<GSpacing>(pixels.step[0]), bytes, nullptr);
  errors.require_written(done == CE_None, s.path);
}

void GeoTiff::finish() {
  State& s = *state_;
  const GdalErrors errors;
  std::vector<int> factors = reductions(s.grid);
  const bool reduced =
      factors.empty() ||
      GDALBuildOverviews(s.file.get(), s.facts.averaging, static_cast<int>(factors.size()),
                         factors.data(), 0, nullptr, nullptr, nullptr) == CE_None;
  GDALFlushCache(s.file.get());
  errors.require_written(reduced, s.path);
  const GdalOptions options{{"COMPRESS", "DEFLATE"},      {"PREDICTOR", "YES"},
                            {"BLOCKSIZE", "512"},         {"BIGTIFF", "IF_SAFER"},
                            {"OVERVIEWS", "AUTO"},        {"OVERVIEW_COMPRESS", "DEFLATE"},
                            {"OVERVIEW_PREDICTOR", "YES"}};
  DatasetPtr map(GDALCreateCopy(GDALGetDriverByName("COG"), s.path.c_str(), s.file.get(), 1,
                                options.list(), nullptr, nullptr));
  errors.require_written(map != nullptr, s.path);
  map.reset();
  errors.require_written(true, s.path);
  s.file.reset();
}

cv::Size reduced_size(const MapGrid& grid, int longest_side) {
  const int longest = std::max(grid.columns, grid.rows),
            shortest = std::min(grid.columns, grid.rows);
  if (longest <= longest_side) return {grid.columns, grid.rows};
  const auto few =
      static_cast<int>(std::max<std::int64_t>(1, std::int64_t{shortest} * longest_side / longest));
  const auto exact = std::lround(double{1} * longest / shortest * few);
  const auto many = static_cast<int>(std::clamp<std::int64_t>(exact, 1, longest_side));
  return grid.columns > grid.rows ? cv::Size(many, few) : cv::Size(few, many);
}

MapGrid grid_of(GDALDatasetH file) {
  std::array<double, 6> transform{};
  GDALGetGeoTransform(file, transform.data());
  return {transform[0], transform[3], transform[1], GDALGetRasterXSize(file),
          GDALGetRasterYSize(file)};
}

StoredMap read_map(const fs::path& path, int longest_side) {
  const GdalErrors errors;
  const DatasetPtr file = open_map(path, errors);
  StoredMap map;
  map.grid = grid_of(file.get());
  map.crs = GDALGetProjectionRef(file.get());
  const int bands = GDALGetRasterCount(file.get());
  const GDALRasterBandH first = GDALGetRasterBand(file.get(), 1);
  const GDALDataType type = GDALGetRasterDataType(first);
  int is_stated = 0;
  const double no_value = GDALGetRasterNoDataValue(first, &is_stated);
  if (is_stated) map.no_value = no_value;
  const int depth = type == GDT_Float32 ? CV_32F : type == GDT_UInt16 ? CV_16U : CV_8U;
  map.pixels.create(reduced_size(map.grid, longest_side), CV_MAKETYPE(depth, bands));
  GDALRasterIOExtraArg how;
  INIT_RASTERIO_EXTRA_ARG(how);
  if (bands == 4) how.eResampleAlg = GRIORA_Average;
  const auto bytes = static_cast<GSpacing>(map.pixels.elemSize1());
  const CPLErr done = GDALDatasetRasterIOEx(
      file.get(), GF_Read, 0, 0, map.grid.columns, map.grid.rows, map.pixels.data, map.pixels.cols,
      map.pixels.rows,
      depth == CV_32F   ? GDT_Float32
      : depth == CV_16U ? GDT_UInt16
                        : GDT_Byte,
      bands, nullptr, bytes * bands, static_cast<GSpacing>(map.pixels.step[0]), bytes, &how);
  errors.require_read(done == CE_None, path);
  return map;
}

}  // namespace axial::map
