// SPDX-License-Identifier: GPL-3.0-or-later
#include <cpl_conv.h>
#include <ogr_srs_api.h>

#include <cmath>
#include <memory>
#include <type_traits>

#include "base/error.h"
#include "map/frame.h"
#include "private/gdal_calls.h"

namespace axial::map {

std::string crs_of_epsg(int code) {
  const GdalErrors errors;
  const auto destroy = [](OGRSpatialReferenceH system) { OSRDestroySpatialReference(system); };
  const std::unique_ptr<std::remove_pointer_t<OGRSpatialReferenceH>, decltype(destroy)> system(
      OSRNewSpatialReference(nullptr), destroy);
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
