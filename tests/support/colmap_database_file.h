// SPDX-License-Identifier: GPL-3.0-or-later
// Writes databases as COLMAP 3.8 does.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "io/colmap/colmap_database.h"

namespace axial::test {

// A database that is open for changes.
class DatabaseFile {
 public:
  // Makes a database without rows, or opens an existing one.
  explicit DatabaseFile(const std::filesystem::path& file) {
    EXPECT_EQ(sqlite3_open(file.c_str(), &database_), SQLITE_OK) << file;
  }
  DatabaseFile(const DatabaseFile&) = delete;
  DatabaseFile& operator=(const DatabaseFile&) = delete;
  ~DatabaseFile() { sqlite3_close(database_); }

  void run(const std::string& command) {
    char* message = nullptr;
    EXPECT_EQ(sqlite3_exec(database_, command.c_str(), nullptr, nullptr, &message), SQLITE_OK)
        << command << ": " << (message ? message : "");
    sqlite3_free(message);
  }

  // Runs `command` with the numbers `data` as the value of its only "?".
  template <class Number>
  void run(const std::string& command, const std::vector<Number>& data) {
    sqlite3_stmt* statement = nullptr;
    ASSERT_EQ(sqlite3_prepare_v2(database_, command.c_str(), -1, &statement, nullptr), SQLITE_OK)
        << command;
    sqlite3_bind_blob(statement, 1, data.data(), static_cast<int>(data.size() * sizeof(Number)),
                      SQLITE_TRANSIENT);
    EXPECT_EQ(sqlite3_step(statement), SQLITE_DONE) << command;
    sqlite3_finalize(statement);
  }

 private:
  sqlite3* database_ = nullptr;
};

// The tables of COLMAP 3.8 that are read.
inline constexpr std::string_view kDatabaseTables =
    "CREATE TABLE cameras (camera_id INTEGER PRIMARY KEY, model INTEGER, width INTEGER, height "
    "INTEGER, params BLOB, prior_focal_length INTEGER);"
    "CREATE TABLE images (image_id INTEGER PRIMARY KEY, name TEXT, camera_id INTEGER, prior_qw "
    "REAL);"
    "CREATE TABLE keypoints (image_id INTEGER PRIMARY KEY, rows INTEGER, cols INTEGER, data BLOB);"
    "CREATE TABLE two_view_geometries (pair_id INTEGER PRIMARY KEY, rows INTEGER, cols INTEGER, "
    "data BLOB, config INTEGER, F BLOB);";

// Writes a new file with the contents of `database`. Each feature has six numbers, and each pair
// has a calibrated two-view geometry.
inline void write_database(const std::filesystem::path& file, const io::ColmapDatabase& database) {
  const std::map<std::string, int> models{
      {"SIMPLE_PINHOLE", 0}, {"PINHOLE", 1}, {"SIMPLE_RADIAL", 2}, {"RADIAL", 3}, {"OPENCV", 4}};
  std::filesystem::remove(file);
  DatabaseFile out(file);
  out.run("BEGIN");
  out.run(std::string(kDatabaseTables));
  for (const io::ColmapCamera& camera : database.cameras)
    out.run(fmt::format("INSERT INTO cameras VALUES ({}, {}, {}, {}, ?, 0)", camera.id,
                        models.at(camera.model), camera.width, camera.height),
            camera.params);
  for (const io::DatabaseImage& image : database.images) {
    out.run(fmt::format("INSERT INTO images VALUES ({}, '{}', {}, NULL)", image.id, image.name,
                        image.camera));
    std::vector<float> numbers;
    for (const io::ColmapPoint2D& feature : image.features)
      numbers.insert(numbers.end(), {static_cast<float>(feature.x), static_cast<float>(feature.y),
                                     1.0f, 0.0f, 0.0f, 1.0f});
    out.run(
        fmt::format("INSERT INTO keypoints VALUES ({}, {}, 6, ?)", image.id, image.features.size()),
        numbers);
  }
  for (const io::DatabasePair& pair : database.pairs) {
    std::vector<std::uint32_t> numbers;
    for (const auto& match : pair.matches)
      numbers.insert(numbers.end(), match.begin(), match.end());
    out.run(fmt::format("INSERT INTO two_view_geometries VALUES ({}, {}, 2, ?, 2, NULL)",
                        std::int64_t{2147483647} * pair.first + pair.second, pair.matches.size()),
            numbers);
  }
  out.run("COMMIT");
}

}  // namespace axial::test
