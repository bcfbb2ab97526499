// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/program/bundled_data.h"

#include <cstdlib>
#include <string>

namespace axial {
namespace fs = std::filesystem;

namespace {

void set_variable(const char* name, const std::string& value) {
  ::setenv(name, value.c_str(), 1);
}

}  // namespace

void use_bundled_data(const fs::path& prefix) {
  const fs::path folder = prefix / "share/axialmvs";
  std::error_code ignored;
  if (fs::is_directory(folder / "gdal", ignored)) {
    set_variable("GDAL_DATA", (folder / "gdal").string());
    set_variable("GDAL_DRIVER_PATH", "disable");
  }
  if (fs::is_directory(folder / "proj", ignored)) {
    std::string folders = (folder / "proj").string();
    const char* of_user = std::getenv("PROJ_DATA");
    if (!of_user) of_user = std::getenv("PROJ_LIB");
    if (of_user) folders.append(":").append(of_user);
    set_variable("PROJ_DATA", folders);
  }
}

}  // namespace axial
