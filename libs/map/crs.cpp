// SPDX-License-Identifier: GPL-3.0-or-later
#include <cpl_conv.h>
#include <ogr_srs_api.h>

#include <array>
#include <cmath>

#include "base/error.h"
#include "map/frame.h"
#include "private/gdal_calls.h"
#include "private/ogr_handles.h"

namespace axial::map {

std::string crs_of_epsg(int code) {
  const GdalErrors errors;
  const System system(OSRNewSpatialReference(nullptr));
  if (OSRImportFromEPSG(system.get(), code) != OGRERR_NONE)
    fail("{} {}: is no coordinate reference system that PROJ knows", setting("epsg"), code);
  if (!OSRIsProjected(system.get()) ||
      std::abs(OSRGetLinearUnits(system.get(), nullptr) - 1) > 1e-12)
    fail("{} {}: is no projected coordinate reference system with metres as unit", setting("epsg"),
         code);
  // WKT 1, because GeoTIFF and LAS of many programs do not read WKT 2.
  const std::array<const char*, 2> options{"FORMAT=WKT1_GDAL", nullptr};
  char* text = nullptr;
  const OGRErr result = OSRExportToWktEx(system.get(), &text, options.data());
  const std::string wkt = text ? text : "";
  CPLFree(text);
  if (result != OGRERR_NONE || wkt.empty())
    fail("{} {}: cannot be written as WKT 1, which maps and LAS state", setting("epsg"), code);
  return wkt;
}

}  // namespace axial::map
