// SPDX-License-Identifier: GPL-3.0-or-later
#include "private/gdal_calls.h"

#include <gdal_frmts.h>
#include <ogrsf_frmts.h>

#include <cerrno>
#include <cstring>
#include <exception>
#include <mutex>
#include <new>
#include <system_error>

#include "base/error.h"
#include "base/log.h"
#include "map/geotiff.h"

namespace axial::map {
namespace {

namespace fs = std::filesystem;

// GDAL aborts after an error of the level CE_Fatal: a small block of memory could not be allocated.
[[noreturn]] void end_without_memory() {
  try {
    throw std::bad_alloc();
  } catch (...) {
    std::terminate();  // writes a line and ends the program (base/program/out_of_memory.h)
  }
}

// GDAL reports a failed write as such, and the system's error number tells why. Other numbers may
// be of an earlier call that did not fail.
bool explains_a_failed_write(int system_error) {
  switch (system_error) {
    case ENOSPC:
    case EFBIG:
    case EDQUOT:
    case EIO:
    case EROFS:
    case EACCES:
    case EPERM:
    case ENAMETOOLONG:
      return true;
    default:
      return false;
  }
}

std::string reason_to_write(const fs::path& file, CPLErrorNum number, int system_error) {
  std::error_code ignored;
  if (number == CPLE_OutOfMemory || system_error == ENOMEM) return "there is not enough memory";
  if (!file.parent_path().empty() && !fs::is_directory(file.parent_path(), ignored))
    return "its folder does not exist";
  return explains_a_failed_write(system_error) ? std::strerror(system_error) : "the write failed";
}

// `kind`: of the file that was expected.
std::string reason_to_read(const fs::path& file, CPLErrorNum number, const char* kind) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return "it does not exist";
  if (number == CPLE_OutOfMemory)
    return "it is damaged, or there is not enough memory for its tiles";
  return fmt::format("it is no {}, or it is damaged", kind);
}

void require_regular_file(const fs::path& file) {
  std::error_code ignored;
  if (fs::exists(file, ignored) && !fs::is_regular_file(file, ignored))
    fail_in(file, "is not a regular file");
}

}  // namespace

void start_gdal() {
  static std::once_flag once;
  std::call_once(once, [] {
    GDALRegister_GTiff();
    GDALRegister_COG();
    RegisterOGRGeoJSON();
    RegisterOGRGeoPackage();
    RegisterOGRShape();
    RegisterOGRDXF();
    GDALSetCacheMax64(static_cast<GIntBig>(kCacheBytes));
  });
}

GdalErrors::GdalErrors() {
  start_gdal();
  errno = 0;
  CPLPushErrorHandlerEx(&GdalErrors::collect, this);
}

GdalErrors::~GdalErrors() {
  CPLPopErrorHandler();
}

void CPL_STDCALL GdalErrors::collect(CPLErr level, CPLErrorNum number, const char* message) {
  if (level == CE_Fatal) end_without_memory();
  if (level < CE_Failure) return;
  auto& self = *static_cast<GdalErrors*>(CPLGetErrorHandlerUserData());
  if (!self.failed_) {
    self.failed_ = true;
    self.number_ = number;
    self.system_error_ = errno;
  }
  log_details("GDAL: {}", message);
}

void GdalErrors::require_written(bool works, const fs::path& file) const {
  if (works && !failed_) return;
  fail_in(file, "cannot be written: {}", reason_to_write(file, number_, system_error_));
}

void GdalErrors::require_read(bool works, const fs::path& file) const {
  if (works && !failed_) return;
  fail_in(file, "cannot be read: {}", reason_to_read(file, number_, "GeoTIFF"));
}

void GdalErrors::require_vectors_read(bool works, const fs::path& file) const {
  if (works && !failed_) return;
  fail_in(file, "cannot be read: {}",
          reason_to_read(file, number_, "GeoJSON, GeoPackage or shape file"));
}

DatasetPtr open_map(const fs::path& file, const GdalErrors& errors) {
  require_regular_file(file);
  DatasetPtr map(GDALOpen(file.c_str(), GA_ReadOnly));
  errors.require_read(map != nullptr, file);
  return map;
}

DatasetPtr open_vectors(const fs::path& file, const GdalErrors& errors) {
  require_regular_file(file);
  DatasetPtr vectors(
      GDALOpenEx(file.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, nullptr, nullptr, nullptr));
  errors.require_vectors_read(vectors != nullptr, file);
  return vectors;
}

}  // namespace axial::map
