// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/colmap/colmap_database.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "io/same_colmap.h"
#include "io/wrong_input.h"
#include "support/colmap_database_file.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using test::DatabaseFile;
using test::error_of;
using testing::HasSubstr;

ColmapDatabase small_database() {
  ColmapDatabase database;
  database.cameras = {{3, "OPENCV", 640, 480, {600, 610, 320, 240, 0.1, 0, 0, 0}},
                      {5, "SIMPLE_RADIAL", 480, 640, {500, 240, 320, 0.05}}};
  database.images = {{1, 3, "a.jpg", {{10.5, 20.25}, {30, 40}, {50, 60}}},
                     {4, 5, "dive/b c.jpg", {{1, 2}, {3, 4}}},
                     {9, 3, "without.jpg", {}}};
  database.pairs = {{1, 4, {{0, 1}, {2, 0}}}};
  return database;
}

class ColmapDatabaseTest : public test::FolderTest {
 protected:
  void SetUp() override { test::write_database(file_(), small_database()); }

  fs::path file_() const { return folder_ / "data base#1%.db"; }
  std::string error() const {
    return error_of([&] { read_colmap_database(file_()); });
  }
  // The error after `command` changed the database.
  std::string error_after(const std::string& command) const {
    test::write_database(file_(), small_database());
    DatabaseFile(file_()).run(command);
    return error();
  }
};

void expect_same(const ColmapDatabase& a, const ColmapDatabase& b) {
  test::expect_same(a.cameras, b.cameras);
  ASSERT_EQ(a.images.size(), b.images.size());
  for (std::size_t i = 0; i < a.images.size(); ++i) {
    EXPECT_EQ(a.images[i].id, b.images[i].id);
    EXPECT_EQ(a.images[i].camera, b.images[i].camera);
    EXPECT_EQ(a.images[i].name, b.images[i].name);
    test::expect_same(a.images[i].features, b.images[i].features);
  }
  ASSERT_EQ(a.pairs.size(), b.pairs.size());
  for (std::size_t i = 0; i < a.pairs.size(); ++i) {
    EXPECT_EQ(a.pairs[i].first, b.pairs[i].first);
    EXPECT_EQ(a.pairs[i].second, b.pairs[i].second);
    EXPECT_EQ(a.pairs[i].matches, b.pairs[i].matches);
  }
}

TEST_F(ColmapDatabaseTest, HoldsCamerasFeaturesAndMatches) {
  expect_same(read_colmap_database(file_()), small_database());
}

TEST_F(ColmapDatabaseTest, FeaturesMayHaveTwoNumbers) {
  DatabaseFile(file_()).run("UPDATE keypoints SET rows = 1, cols = 2, data = ? WHERE image_id = 9",
                            std::vector<float>{7, 8});
  const ColmapDatabase read = read_colmap_database(file_());
  ASSERT_EQ(read.images[2].features.size(), 1u);
  EXPECT_EQ(read.images[2].features[0].x, 7);
  EXPECT_EQ(read.images[2].features[0].y, 8);
}

// COLMAP's features have a scale and an orientation, or an affine shape.
TEST_F(ColmapDatabaseTest, FeaturesHaveSizes) {
  const auto size_of = [&](int columns, const std::vector<float>& row) {
    DatabaseFile(file_()).run(
        fmt::format("UPDATE keypoints SET rows = 1, cols = {}, data = ? WHERE image_id = 9",
                    columns),
        row);
    return read_colmap_database(file_()).images[2].features[0].size;
  };
  EXPECT_EQ(size_of(4, {7, 8, 2.5f, 1}), 2.5f);
  EXPECT_EQ(size_of(6, {7, 8, 0, -2, 8, 0}), 4);  // turned, and stretched by two
  EXPECT_EQ(size_of(2, {7, 8}), 0);
  EXPECT_EQ(size_of(4, {7, 8, -1, 1}), 0);
  EXPECT_EQ(size_of(6, {7, 8, NAN, 0, 0, 1}), 0);
}

TEST_F(ColmapDatabaseTest, PairsWithoutAGeometryAreLeftOut) {
  for (const int config : {0, 1, 7}) {
    DatabaseFile(file_()).run(fmt::format("UPDATE two_view_geometries SET config = {}", config));
    EXPECT_TRUE(read_colmap_database(file_()).pairs.empty()) << config;
  }
  DatabaseFile(file_()).run("UPDATE two_view_geometries SET config = 6");
  EXPECT_EQ(read_colmap_database(file_()).pairs.size(), 1u);
  DatabaseFile(file_()).run("UPDATE two_view_geometries SET rows = 0, data = NULL");
  EXPECT_TRUE(read_colmap_database(file_()).pairs.empty());
}

// COLMAP's databases have a journal, which SQLite would make beside the file.
TEST_F(ColmapDatabaseTest, ReadingLeavesNoTrace) {
  DatabaseFile(file_()).run("PRAGMA journal_mode = WAL");
  const auto changed = fs::last_write_time(file_());
  expect_same(read_colmap_database(file_()), small_database());
  EXPECT_EQ(fs::last_write_time(file_()), changed);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

// As after a program that was killed: the last changes are in the journal.
TEST_F(ColmapDatabaseTest, ChangesInTheJournalCount) {
  const fs::path copy = folder_ / "copy.db";
  {
    DatabaseFile open(file_());
    open.run("PRAGMA journal_mode = WAL");
    open.run("UPDATE images SET name = 'new.jpg' WHERE image_id = 9");
    fs::copy_file(file_(), copy);
    fs::copy_file(file_().string() + "-wal", copy.string() + "-wal");
  }
  EXPECT_EQ(read_colmap_database(copy).images[2].name, "new.jpg");
}

TEST_F(ColmapDatabaseTest, NamesWhatIsWrong) {
  const std::string name = file_().string();
  EXPECT_EQ(error_after("UPDATE cameras SET model = 99 WHERE camera_id = 5"),
            name + ": camera 5: model is 99");
  EXPECT_EQ(error_after("UPDATE cameras SET width = 0"), name + ": camera 3: width is 0");
  EXPECT_EQ(error_after("UPDATE cameras SET params = x'00' WHERE camera_id = 3"),
            name + ": camera 3: params has 1 bytes");
  EXPECT_THAT(error_after("UPDATE cameras SET params = NULL WHERE camera_id = 3"),
              HasSubstr("camera 3 (OPENCV) has 0 parameters, expected 8"));
  EXPECT_EQ(error_after("UPDATE images SET camera_id = 8 WHERE image_id = 4"),
            name + ": image 4: camera_id is 8, which is no camera");
  EXPECT_EQ(error_after("UPDATE images SET name = 'a.jpg'"),
            name + ": image 4: name is 'a.jpg', as that of another image");
  EXPECT_EQ(error_after("UPDATE images SET name = x'41' WHERE image_id = 4"),
            name + ": image 4: name is not a text");
  EXPECT_EQ(error_after("UPDATE keypoints SET rows = 4 WHERE image_id = 1"),
            name + ": keypoints 1: data has 18 numbers, but 4 rows of 6");
  EXPECT_EQ(error_after("UPDATE keypoints SET rows = 18, cols = 1 WHERE image_id = 1"),
            name + ": keypoints 1: cols is 1");
  EXPECT_EQ(error_after("UPDATE keypoints SET image_id = 6 WHERE image_id = 1"),
            name + ": keypoints 6: image_id: there is no image with this id");
  EXPECT_EQ(error_after("UPDATE keypoints SET data = 'text' WHERE image_id = 1"),
            name + ": keypoints 1: data is not a blob");
  EXPECT_EQ(error_after("UPDATE two_view_geometries SET pair_id = 2147483647 * 1 + 5"),
            name + ": two_view_geometries 2147483652: pair_id is no pair of images");
  EXPECT_EQ(error_after("UPDATE two_view_geometries SET rows = -1"),
            name + ": two_view_geometries 2147483651: rows is -1");
}

TEST_F(ColmapDatabaseTest, NamesWrongNumbers) {
  const std::string name = file_().string();
  DatabaseFile(file_()).run("UPDATE two_view_geometries SET rows = 1, data = ?",
                            std::vector<std::uint32_t>{1, 2});
  EXPECT_EQ(error(), name +
                         ": two_view_geometries 2147483651: data: match 0 has the features 1 and "
                         "2, but the images have 3 and 2");
  DatabaseFile(file_()).run("UPDATE keypoints SET rows = 1, cols = 2, data = ? WHERE image_id = 1",
                            std::vector<float>{NAN, 8});
  EXPECT_EQ(error(), name + ": keypoints 1: data: feature 0 is at nan 8");
}

TEST_F(ColmapDatabaseTest, RefusesOtherFiles) {
  const std::string name = file_().string();
  EXPECT_EQ(error_after("DROP TABLE keypoints"),
            name + ": is no database of COLMAP: has no table keypoints");
  EXPECT_EQ(error_after("DROP TABLE images; CREATE VIEW images AS SELECT 1"),
            name + ": is no database of COLMAP: has no table images");
  EXPECT_EQ(error_after("ALTER TABLE images RENAME COLUMN name TO title"),
            name + ": is no database of COLMAP: no such column: name");
  std::ofstream(file_()) << "some text, which is no database";
  EXPECT_EQ(error(), name + ": is no database of COLMAP: file is not a database");
  fs::remove(file_());
  EXPECT_EQ(error(), name + ": file not found");
}

TEST_F(ColmapDatabaseTest, SurvivesDamage) {
  std::ifstream in(file_(), std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  test::expect_damage_survived(
      file_(), bytes, [](const fs::path& file) { read_colmap_database(file); }, 100, 500);
}

}  // namespace
}  // namespace axial::io
