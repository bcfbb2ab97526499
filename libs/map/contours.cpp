// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/contours.h"

#include <gdal_alg.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>

#include <string>

#include "map/geotiff.h"
#include "map/stated_kind.h"
#include "private/vector_output.h"

namespace axial::map {
namespace {

namespace fs = std::filesystem;

// Makes the layer of the lines in `file`, and the lines.
bool make_lines(GDALDatasetH map, double interval, GDALDatasetH file, OGRwkbGeometryType type,
                const GdalOptions& layer_options) {
  const OGRLayerH layer =
      GDALDatasetCreateLayer(file, "contours", GDALGetSpatialRef(map), type, layer_options.list());
  if (layer == nullptr) return false;
  if (!add_field(layer, "ID", OFTInteger) || !add_field(layer, "height", OFTReal)) return false;
  const int first = OGR_FD_GetFieldIndex(OGR_L_GetLayerDefn(layer), "ID");
  const GdalOptions options{{"LEVEL_INTERVAL", fmt::format("{}", interval)},
                            {"ID_FIELD", std::to_string(first)},
                            {"ELEV_FIELD", std::to_string(first + 1)},
                            {"NODATA", fmt::format("{}", kNoHeight)}};
  return GDALContourGenerateEx(GDALGetRasterBand(map, 1), layer, options.list(), nullptr,
                               nullptr) == CE_None;
}

std::string description() {
  return fmt::format("{} {}", kKindItem, kinds::kContours);
}

void write_geojson(GDALDatasetH map, double interval, const fs::path& path,
                   const GdalErrors& errors) {
  DatasetPtr file = make_vector_file("GeoJSON", path, errors);
  const bool works = make_lines(
      map, interval, file.get(), wkbLineString,
      {{"COORDINATE_PRECISION", "4"}, {"WRITE_NAME", "NO"}, {"DESCRIPTION", description()}});
  file.reset();
  errors.require_written(works, path);
  require_complete_geojson(path);
}

void write_package(GDALDatasetH map, double interval, const fs::path& path,
                   const GdalErrors& errors) {
  const FixedDate date;
  DatasetPtr file = make_vector_file("GPKG", path, errors);
  const bool works =
      make_lines(map, interval, file.get(), wkbLineString25D, {{"DESCRIPTION", description()}});
  file.reset();
  errors.require_written(works, path);
}

}  // namespace

void write_contours(const fs::path& heights, double interval, const ContourFiles& files) {
  const GdalErrors errors;
  const DatasetPtr map = open_map(heights, errors);
  if (!files.geojson.empty()) write_geojson(map.get(), interval, files.geojson, errors);
  if (!files.package.empty()) write_package(map.get(), interval, files.package, errors);
  if (!files.drawing.empty()) write_drawing(files.package, "contours", files.drawing);
}

}  // namespace axial::map
