// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/map: writing files for GIS programs.
#pragma once

#include <cpl_conv.h>

#include <filesystem>
#include <string>

#include "private/gdal_calls.h"
#include "private/ogr_handles.h"

namespace axial::map {

// Sets an option of GDAL for this thread while the object exists.
class GdalSetting {
 public:
  GdalSetting(const char* key, const char* value) : key_(key) {
    CPLSetThreadLocalConfigOption(key, value);
  }
  ~GdalSetting() { CPLSetThreadLocalConfigOption(key_, nullptr); }
  GdalSetting(const GdalSetting&) = delete;
  GdalSetting& operator=(const GdalSetting&) = delete;

 private:
  const char* key_;
};

// A GeoPackage that states 2000-01-01 as the date of its last change while this object exists, so
// that the same features give the same bytes.
class FixedDate : public GdalSetting {
 public:
  FixedDate() : GdalSetting("OGR_CURRENT_DATE", "2000-01-01T00:00:00.000Z") {}
};

// Makes an empty file. Error that names the file if that is not possible.
DatasetPtr make_vector_file(const char* driver, const std::filesystem::path& file,
                            const GdalErrors& errors);

// Writes the lines of the only layer of the GeoPackage `package` as DXF, all on the layer `layer`
// of the drawing. Error that names the file that cannot be read or written.
void write_drawing(const std::filesystem::path& package, const char* layer,
                   const std::filesystem::path& file);

// Error that names `file` if a GeoJSON is cut off: GDAL does not notice a failed write, for example
// on a full disk.
void require_complete_geojson(const std::filesystem::path& file);

}  // namespace axial::map
