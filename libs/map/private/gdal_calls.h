// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/map: GDAL's errors as Errors.
#pragma once

#include <cpl_error.h>
#include <gdal.h>

#include <filesystem>
#include <string>

namespace axial::map {

// Registers GDAL's drivers and limits its cache, once.
void start_gdal();

// Collects the errors of GDAL's calls on this thread while it exists, instead of printing them.
class GdalErrors {
 public:
  GdalErrors();
  ~GdalErrors();
  GdalErrors(const GdalErrors&) = delete;
  GdalErrors& operator=(const GdalErrors&) = delete;

  // The first error since the object exists; empty if there was none.
  const std::string& first() const { return first_; }
  // Throws an Error "<subject>: <first error>" if there was an error, or if `works` is false.
  void require(bool works, const std::string& subject) const;

 private:
  static void CPL_STDCALL collect(CPLErr level, CPLErrorNum number, const char* message);

  std::string first_;
};

}  // namespace axial::map
