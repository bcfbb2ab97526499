// SPDX-License-Identifier: GPL-3.0-or-later
#include "private/gdal_calls.h"

#include <gdal_frmts.h>
#include <ogrsf_frmts.h>

#include <mutex>

#include "base/error.h"
#include "map/geotiff.h"

namespace axial::map {

void start_gdal() {
  static std::once_flag once;
  std::call_once(once, [] {
    GDALRegister_GTiff();
    GDALRegister_COG();
    RegisterOGRGeoJSON();
    GDALSetCacheMax64(static_cast<GIntBig>(kCacheBytes));
  });
}

GdalErrors::GdalErrors() {
  start_gdal();
  CPLPushErrorHandlerEx(&GdalErrors::collect, this);
}

GdalErrors::~GdalErrors() {
  CPLPopErrorHandler();
}

void CPL_STDCALL GdalErrors::collect(CPLErr level, CPLErrorNum, const char* message) {
  auto& self = *static_cast<GdalErrors*>(CPLGetErrorHandlerUserData());
  if (level >= CE_Failure && self.first_.empty()) self.first_ = message;
}

void GdalErrors::require(bool works, const std::string& subject) const {
  if (works && first_.empty()) return;
  fail("{}: {}", subject, first_.empty() ? "GDAL cannot write or read it" : first_);
}

}  // namespace axial::map
