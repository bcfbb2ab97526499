// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/map: GDAL's errors as Errors, its files and lists of options.
#pragma once

#include <cpl_error.h>
#include <cpl_string.h>
#include <gdal.h>

#include <filesystem>
#include <initializer_list>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

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

  // Throws an Error if there was an error since the object exists, or if `works` is false: that the
  // file cannot be written, and why, in our words. GDAL's words are in the log of details.
  void require_written(bool works, const std::filesystem::path& file) const;
  // The same for a file that was read.
  void require_read(bool works, const std::filesystem::path& file) const;
  // The same for a file of points, lines or polygons.
  void require_vectors_read(bool works, const std::filesystem::path& file) const;

 private:
  static void CPL_STDCALL collect(CPLErr level, CPLErrorNum number, const char* message);

  // Of the first error.
  bool failed_ = false;
  CPLErrorNum number_ = CPLE_None;
  int system_error_ = 0;  // errno
};

// GDAL's words "KEY=VALUE".
class GdalOptions {
 public:
  GdalOptions(std::initializer_list<std::pair<const char*, std::string>> pairs) {
    for (const auto& [key, value] : pairs) list_ = CSLSetNameValue(list_, key, value.c_str());
  }
  ~GdalOptions() { CSLDestroy(list_); }
  GdalOptions(const GdalOptions&) = delete;
  GdalOptions& operator=(const GdalOptions&) = delete;
  char** list() const { return list_; }

 private:
  char** list_ = nullptr;
};

// Closes a file of GDAL. Errors while it is closed are those of the last writes.
struct Close {
  void operator()(GDALDatasetH file) const { GDALClose(file); }
};
using DatasetPtr = std::unique_ptr<std::remove_pointer_t<GDALDatasetH>, Close>;

// Opens a map, or a file of points, lines or polygons, to read it. Error if it cannot be opened or
// is not a regular file: GDAL would wait for ever for the writer of a pipe.
DatasetPtr open_map(const std::filesystem::path& file, const GdalErrors& errors);
DatasetPtr open_vectors(const std::filesystem::path& file, const GdalErrors& errors);

}  // namespace axial::map
