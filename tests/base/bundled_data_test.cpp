// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/program/bundled_data.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "support/empty_folder.h"

namespace axial {
namespace {

namespace fs = std::filesystem;

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "not set";
}

class BundledData : public testing::Test {
 protected:
  fs::path prefix_ = test::empty_folder();
  fs::path data_ = prefix_ / "share/axialmvs";
  void SetUp() override { forget(); }
  void TearDown() override {
    forget();
    fs::remove_all(prefix_);
  }
  static void forget() {
    for (const char* name : {"GDAL_DATA", "GDAL_DRIVER_PATH", "PROJ_DATA", "PROJ_LIB"})
      ::unsetenv(name);
  }
};

TEST_F(BundledData, NoFoldersChangeNothing) {
  ::setenv("GDAL_DATA", "/of/user", 1);
  use_bundled_data(prefix_);
  EXPECT_EQ(variable("GDAL_DATA"), "/of/user");
  EXPECT_EQ(variable("GDAL_DRIVER_PATH"), "not set");
  EXPECT_EQ(variable("PROJ_DATA"), "not set");
}

TEST_F(BundledData, ReplacesDataOfAnotherVersion) {
  fs::create_directories(data_ / "gdal");
  fs::create_directories(data_ / "proj");
  ::setenv("GDAL_DATA", "/of/user", 1);
  use_bundled_data(prefix_);
  EXPECT_EQ(variable("GDAL_DATA"), data_ / "gdal");
  EXPECT_EQ(variable("GDAL_DRIVER_PATH"), "disable");
  EXPECT_EQ(variable("PROJ_DATA"), data_ / "proj");
}

TEST_F(BundledData, KeepsTheUsersGrids) {
  fs::create_directories(data_ / "proj");
  ::setenv("PROJ_LIB", "/old", 1);
  use_bundled_data(prefix_);
  EXPECT_EQ(variable("PROJ_DATA"), (data_ / "proj").string() + ":/old");
  ::setenv("PROJ_DATA", "/new", 1);
  use_bundled_data(prefix_);
  EXPECT_EQ(variable("PROJ_DATA"), (data_ / "proj").string() + ":/new");
}

}  // namespace
}  // namespace axial
