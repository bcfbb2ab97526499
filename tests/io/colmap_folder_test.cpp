// SPDX-License-Identifier: GPL-3.0-or-later
// Folders with the files of a COLMAP model in both forms, or in several places.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>

#include "base/atomic_file.h"
#include "io/colmap/colmap.h"
#include "io/same_colmap.h"
#include "io/wrong_input.h"
#include "support/captured_events.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using testing::HasSubstr;

constexpr std::array<const char*, 3> kParts{"cameras", "images", "points3D"};

// Far from the origin, where centres have few digits behind the point.
ColmapModel small_model() {
  ColmapModel model = test::small_model();
  for (ColmapImage& image : model.images) image.pose.centre = {534000.125, 3378500.5, 30};
  return model;
}

// The model with a change in the parts that `where` marks.
ColmapModel changed(const std::array<bool, 3>& where) {
  ColmapModel model = small_model();
  if (where[0]) model.cameras[0].params[0] += 0.01;
  if (where[1]) model.images[1].pose.centre.z() += 0.5;
  if (where[2]) model.points.pop_back();
  return model;
}

void remove_parts(const fs::path& folder, const char* extension, const std::array<bool, 3>& kept) {
  for (std::size_t i = 0; i < 3; ++i)
    if (!kept[i]) fs::remove(folder / (std::string(kParts[i]) + extension));
}

bool all(const std::array<bool, 3>& flags) {
  return flags[0] && flags[1] && flags[2];
}

std::array<bool, 3> any_flags() {
  return {*rc::gen::arbitrary<bool>(), *rc::gen::arbitrary<bool>(), *rc::gen::arbitrary<bool>()};
}

// Any combination of files. The complete binary model is read, otherwise the complete text model.
// The warning names exactly the existing files that differ.
RC_GTEST_PROP(ColmapFolder, IsReadAsColmapDoes, ()) {
  const fs::path folder = test::empty_folder();
  const auto differs = any_flags(), text = any_flags(), binary = any_flags();
  write_colmap_text(folder, changed(differs));
  write_colmap_binary(folder, small_model());
  remove_parts(folder, ".txt", text);
  remove_parts(folder, ".bin", binary);
  test::CapturedEvents log;
  if (!all(text) && !all(binary)) {
    const std::string error = error_of([&] { read_colmap_model(folder); });
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string part = kParts[i];
      RC_ASSERT((error.find(part + ".txt") == std::string::npos) == text[i]);
      RC_ASSERT((error.find(part + ".bin") == std::string::npos) == binary[i]);
    }
    return;
  }
  const ColmapModel read = read_colmap_model(folder, log.context);
  RC_ASSERT((read.cameras[0].params[0] == 500) == (all(binary) || !differs[0]));
  RC_ASSERT((read.points.size() == 2) == (all(binary) || !differs[2]));
  const std::string said = log.lines;
  bool any = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const bool ignored = differs[i] && text[i] && binary[i];
    for (const char* extension : {".txt", ".bin"})
      RC_ASSERT((said.find(std::string(kParts[i]) + extension) != std::string::npos) == ignored);
    any = any || ignored;
  }
  RC_ASSERT(std::ranges::count(said, '\n') == (any ? 1 : 0));
}

class ColmapFolderTest : public test::FolderTest {
 protected:
  std::string said_on_reading() const {
    test::CapturedEvents log;
    read_colmap_model(folder_, log.context);
    return log.lines;
  }
};

TEST_F(ColmapFolderTest, NamesBothFiles) {
  write_colmap_text(folder_, changed({true, false, true}));
  write_colmap_binary(folder_, small_model());
  EXPECT_THAT(said_on_reading(),
              HasSubstr(folder_.string() + ": cameras.bin, points3D.bin are read, as in COLMAP; "
                                           "ignored: cameras.txt, points3D.txt, which differ"));
}

// The order of the elements and rounding in the quaternions do not count as differences.
TEST_F(ColmapFolderTest, IsSilentAboutTheSameModelInAnotherOrder) {
  ColmapModel model = small_model();
  write_colmap_binary(folder_, model);
  fs::create_directories(folder_ / "text");
  std::ranges::reverse(model.cameras);
  std::ranges::reverse(model.images);
  std::ranges::reverse(model.points);
  std::ranges::reverse(model.points[1].track);
  write_colmap_text(folder_ / "text", model);
  for (const char* part : kParts)
    fs::rename(folder_ / "text" / (std::string(part) + ".txt"),
               folder_ / (std::string(part) + ".txt"));
  EXPECT_EQ(said_on_reading(), "");
}

TEST_F(ColmapFolderTest, WarnsOfAFileThatCannotBeRead) {
  write_colmap_binary(folder_, small_model());
  test::put(folder_ / "images.txt", "stale");
  EXPECT_THAT(said_on_reading(),
              HasSubstr("images.bin is read, as in COLMAP; ignored: images.txt"));
}

// A folder with only a lens needs no complete model.
TEST_F(ColmapFolderTest, CamerasAloneGoByTheSameOrder) {
  test::CapturedEvents log;
  const auto focal = [&] { return read_colmap_cameras(folder_, log.context).at(0).params[0]; };
  write_colmap_text(folder_, changed({true, false, false}));
  EXPECT_EQ(focal(), 500.01);
  write_colmap_binary(folder_, small_model());
  for (const char* name : {"images.bin", "points3D.bin"}) fs::remove(folder_ / name);
  EXPECT_EQ(focal(), 500.01) << "the text model is whole";
  EXPECT_THAT(log.lines, HasSubstr("cameras.txt is read, as in COLMAP; ignored: cameras.bin"));
  for (const char* name : {"images.txt", "points3D.txt"}) fs::remove(folder_ / name);
  EXPECT_EQ(focal(), 500) << "of two files alone the binary one";
  EXPECT_THAT(log.lines, HasSubstr("cameras.bin is read, as in COLMAP; ignored: cameras.txt"));
  EXPECT_EQ(read_colmap_cameras(folder_ / "cameras.txt").at(0).params[0], 500.01);
}

TEST_F(ColmapFolderTest, TextIsNotWrittenWhereItWouldNotBeRead) {
  write_colmap_binary(folder_, small_model());
  EXPECT_THAT(error_of([&] { write_colmap_text(folder_, small_model()); }),
              HasSubstr(folder_.string() + ": holds a binary model"));
}

TEST_F(ColmapFolderTest, NamesModelsInOtherPlaces) {
  const fs::path sparse = folder_ / "sparse";
  for (const fs::path& place : {sparse / "0", sparse / "1", sparse / "2", folder_}) {
    fs::create_directories(place);
    write_colmap_text(place, small_model());
  }
  test::put(sparse / "cameras.txt", "stale");  // not a complete model
  const auto said = [&] {
    test::CapturedEvents log;
    const fs::path found = find_colmap_model(folder_, log.context);
    return std::pair(found, log.lines);
  };
  EXPECT_EQ(said().first, sparse / "0");
  EXPECT_THAT(said().second, HasSubstr((sparse / "0").string() + ": this model is read; ignored: " +
                                       folder_.string() + ", " + (sparse / "1").string() + ", " +
                                       (sparse / "2").string() + "\n"));
  write_colmap_binary(sparse, small_model());
  EXPECT_EQ(said().first, sparse);
  EXPECT_THAT(said().second, HasSubstr((sparse / "0").string() + ", " + folder_.string() + "\n"));
  fs::remove_all(sparse / "0");
  for (const char* part : kParts) fs::remove(folder_ / (std::string(part) + ".txt"));
  EXPECT_EQ(said().second, "");
}

}  // namespace
}  // namespace axial::io
