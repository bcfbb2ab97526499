// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/contours.h"

#include <gdal_alg.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <string>

#include "base/error.h"
#include "map/geotiff.h"
#include "map/stated_kind.h"
#include "private/gdal_calls.h"
#include "private/ogr_handles.h"

namespace axial::map {
namespace {

// GDAL does not notice a failed write of GeoJSON, for example on a full disk.
void require_complete(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  const auto size = static_cast<std::streamoff>(in.tellg());
  std::string end(static_cast<std::size_t>(std::clamp<std::streamoff>(size, 0, 16)), '\0');
  in.seekg(size - static_cast<std::streamoff>(end.size()));
  in.read(end.data(), static_cast<std::streamsize>(end.size()));
  std::erase_if(end, [](unsigned char c) { return std::isspace(c) != 0; });
  if (!in || !end.ends_with("]}"))
    fail_in(path, "cannot be written: only a part of it was written: is the disk full?");
}

}  // namespace

void write_contours(const std::filesystem::path& heights, double interval,
                    const std::filesystem::path& path) {
  const GdalErrors errors;
  const DatasetPtr map = open_map(heights, errors);
  DatasetPtr file(
      GDALCreate(GDALGetDriverByName("GeoJSON"), path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  errors.require_written(file != nullptr, path);
  const GdalOptions layer_options{
      {"COORDINATE_PRECISION", "4"},
      {"WRITE_NAME", "NO"},
      {"DESCRIPTION", fmt::format("{} {}", kKindItem, kinds::kContours)}};
  const OGRLayerH layer = GDALDatasetCreateLayer(
      file.get(), "contours", GDALGetSpatialRef(map.get()), wkbLineString, layer_options.list());
  errors.require_written(layer != nullptr, path);
  errors.require_written(add_field(layer, "ID", OFTInteger) && add_field(layer, "height", OFTReal),
                         path);
  const GdalOptions options{{"LEVEL_INTERVAL", fmt::format("{}", interval)},
                            {"ID_FIELD", "0"},
                            {"ELEV_FIELD", "1"},
                            {"NODATA", fmt::format("{}", kNoHeight)}};
  const CPLErr done = GDALContourGenerateEx(GDALGetRasterBand(map.get(), 1), layer, options.list(),
                                            nullptr, nullptr);
  file.reset();
  errors.require_written(done == CE_None, path);
  require_complete(path);
}

}  // namespace axial::map
