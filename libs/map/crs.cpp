// SPDX-License-Identifier: GPL-3.0-or-later
#include <cpl_conv.h>
#include <ogr_srs_api.h>

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
  char* text = nullptr;
  OSRExportToWkt(system.get(), &text);
  const std::string wkt = text;
  CPLFree(text);
  return wkt;
}

}  // namespace axial::map
