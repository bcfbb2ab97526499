// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/reduced_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "base/error.h"
#include "base/program/out_of_memory.h"
#include "map/stated_kind.h"
#include "private/gdal_calls.h"
#include "private/map_metadata.h"

namespace axial::map {
namespace {

namespace fs = std::filesystem;

struct BandsOfKind {
  const char* name;
  int count;
  GDALDataType type;
};

BandsOfKind bands_of(MapKind kind) {
  switch (kind) {
    case MapKind::heights:
      return {"heights", 1, GDT_Float32};
    case MapKind::colors:
      return {"colours", 4, GDT_Byte};
    case MapKind::counts:
      return {"numbers of views", 1, GDT_UInt16};
    case MapKind::classes:
      return {"classes", 1, GDT_Byte};
    case MapKind::shades:
      break;
  }
  return {"shades", 1, GDT_Byte};
}

std::string words_of(int count, GDALDataType type) {
  return fmt::format("{} band{} of {}", count, count == 1 ? "" : "s", GDALGetDataTypeName(type));
}

void check_bands(GDALDatasetH file, MapKind kind, const fs::path& path) {
  const BandsOfKind wanted = bands_of(kind);
  const int count = GDALGetRasterCount(file);
  if (count == 0) fail_in(path, "has no bands");
  const GDALDataType type = GDALGetRasterDataType(GDALGetRasterBand(file, 1));
  if (count != wanted.count || type != wanted.type)
    fail_in(path, "has {}, but a map of {} has {}", words_of(count, type), wanted.name,
            words_of(wanted.count, wanted.type));
}

// A file that states no kind is refused, too: another program or an earlier version wrote it, and
// its name alone does not show what its values are.
void check_kind(GDALDatasetH file, const std::string& wanted, const fs::path& path) {
  const char* item = GDALGetMetadataItem(file, kKindItem, nullptr);
  const std::string found = item == nullptr ? "" : item;
  if (wanted.empty() || found == wanted) return;
  const char* program = wanted.starts_with("map.") ? "MapSurface" : "CompareSurveys";
  if (found.empty())
    fail_in(path, "AXIALMVS_KIND is missing: must be {}, as {} writes it", wanted, program);
  fail_in(path, "AXIALMVS_KIND {}: must be {}, as {} writes it", found, wanted, program);
}

// GDAL reads whole blocks. Damaged numbers can make them as large as all memory.
void check_blocks(GDALDatasetH file, const fs::path& path) {
  constexpr double kMost = 1e9;  // of one block [bytes]
  int columns = 0, rows = 0;
  const GDALRasterBandH band = GDALGetRasterBand(file, 1);
  GDALGetBlockSize(band, &columns, &rows);
  const int bytes = GDALGetDataTypeSizeBytes(GDALGetRasterDataType(band));
  if (double{1} * columns * rows * bytes * GDALGetRasterCount(file) > kMost)
    fail_in(path, "has blocks of {} x {} pixels: it is damaged, or must be stored in smaller tiles",
            columns, rows);
}

MapGrid grid_of(GDALDatasetH file, const fs::path& path) {
  std::array<double, 6> t{};
  const bool is_stated = GDALGetGeoTransform(file, t.data()) == CE_None;
  const bool is_finite = std::ranges::all_of(t, [](double value) { return std::isfinite(value); });
  constexpr double kTolerance = 1e-6;
  if (!is_stated || !is_finite || !(t[1] > 0) || t[2] != 0 || t[4] != 0 ||
      !(std::abs(t[5] + t[1]) <= kTolerance * t[1]))
    fail_in(path, "has no geotransform of a map with square pixels whose y axis points upwards");
  return {t[0], t[3], t[1], GDALGetRasterXSize(file), GDALGetRasterYSize(file)};
}

// Calls `read`. If memory runs out, the Error names the file: damaged sizes are the likely cause.
template <class Read>
cv::Mat with_memory(const fs::path& path, const Read& read) {
  try {
    return read();
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    if (!is_out_of_memory(error)) throw;
    fail_in(path, "cannot be read: it is damaged, or there is not enough memory for it");
  }
}

// The pixels of the file with `size` pixels, in their own type for colours and otherwise as float.
cv::Mat read_pixels(GDALDatasetH file, MapKind kind, const MapGrid& grid, cv::Size size,
                    const GdalErrors& errors, const fs::path& path) {
  const bool colors = kind == MapKind::colors;
  cv::Mat pixels(size, colors ? CV_8UC4 : CV_32FC1);
  GDALRasterIOExtraArg how;
  INIT_RASTERIO_EXTRA_ARG(how);
  if (kind != MapKind::classes) how.eResampleAlg = GRIORA_Average;
  const int bands = pixels.channels();
  const auto bytes = static_cast<GSpacing>(pixels.elemSize1());
  const CPLErr done =
      GDALDatasetRasterIOEx(file, GF_Read, 0, 0, grid.columns, grid.rows, pixels.data, size.width,
                            size.height, colors ? GDT_Byte : GDT_Float32, bands, nullptr,
                            bytes * bands, static_cast<GSpacing>(pixels.step[0]), bytes, &how);
  errors.require_read(done == CE_None, path);
  return pixels;
}

void mark_missing(GDALDatasetH file, cv::Mat1f values) {
  int is_stated = 0;
  const double no_value = GDALGetRasterNoDataValue(GDALGetRasterBand(file, 1), &is_stated);
  for (float& value : values)
    if (!std::isfinite(value) || (is_stated && value == static_cast<float>(no_value)))
      value = std::numeric_limits<float>::quiet_NaN();
}

}  // namespace

ReducedMap read_reduced_map(const fs::path& path, MapKind kind, int longest_side,
                            const std::string& stated) {
  const GdalErrors errors;
  const DatasetPtr file = open_map(path, errors);
  check_bands(file.get(), kind, path);
  check_kind(file.get(), stated, path);
  check_blocks(file.get(), path);
  ReducedMap map;
  map.grid = grid_of(file.get(), path);
  map.axes = axes_in(file.get(), path);
  const int longest = std::max(map.grid.columns, map.grid.rows);
  const double scale = std::min(1.0, static_cast<double>(longest_side) / longest);
  const auto reduced = [&](int side) { return std::max(1, static_cast<int>(side * scale + 0.5)); };
  map.pixels = with_memory(path, [&] {
    return read_pixels(file.get(), kind, map.grid,
                       {reduced(map.grid.columns), reduced(map.grid.rows)}, errors, path);
  });
  if (kind != MapKind::colors) mark_missing(file.get(), map.pixels);
  return map;
}

}  // namespace axial::map
