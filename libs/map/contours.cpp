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

void write_contours(const std::filesystem::path& heights, double interval,
                    const std::filesystem::path& path) {
  const GdalErrors errors;
  const DatasetPtr map = open_map(heights, errors);
  DatasetPtr file = make_vector_file("GeoJSON", path, errors);
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
  require_complete_geojson(path);
}

}  // namespace axial::map
