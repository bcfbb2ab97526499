// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/atomic_file.h"
#include "io/mvs_bytes.h"
#include "io/openmvs/mvs.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using testing::HasSubstr;

TEST_F(MvsTest, WritesNormalisedIntrinsicsThatAreReadBack) {
  const fs::path copy = folder_ / "normalised.mvs";
  for (const double cx : {319.5, 320.0, 250.25, 400.0})
    for (const double cy : {239.5, 240.0, 180.75}) {
      Description d;
      d.k[2] = cx;
      d.k[5] = cy;
      const Scene scene = read(d);
      write_mvs(copy, scene, folder_, MvsIntrinsics::normalised);
      const CameraModel again = read_mvs(copy, folder_).images[0].camera;
      EXPECT_EQ(again.width, 640);
      EXPECT_EQ(again.height, 480);
      EXPECT_NEAR(again.lens.fx, 500, 1e-9);
      EXPECT_NEAR(again.lens.fy, 510, 1e-9);
      EXPECT_NEAR(again.lens.cx, cx, 1e-9);
      EXPECT_NEAR(again.lens.cy, cy, 1e-9);
    }
  Description d;
  d.k[2] = 500;  // would be read with the other convention
  const Scene scene = read(d);
  EXPECT_THAT(error_of([&] { write_mvs(copy, scene, folder_, MvsIntrinsics::normalised); }),
              HasSubstr("(500, 240)"));
}

TEST_F(MvsTest, KeepsEverythingTheSceneHolds) {
  Description d;
  d.box_max = {1, 2, 3};
  const Scene scene = read(d);
  const fs::path copy = folder_ / "copy.mvs";
  write_mvs(copy, scene, folder_);
  const Scene again = read_mvs(copy, folder_);
  ASSERT_EQ(again.images.size(), scene.images.size());
  for (std::size_t i = 0; i < scene.images.size(); ++i) {
    const SceneImage &a = scene.images[i], &b = again.images[i];
    EXPECT_EQ(a.path, b.path);
    EXPECT_EQ(a.mask_path, b.mask_path);
    EXPECT_EQ(a.id, b.id);
    EXPECT_EQ(a.calibrated, b.calibrated);
    EXPECT_EQ(a.camera.width, b.camera.width);
    EXPECT_EQ(a.camera.lens.cy, b.camera.lens.cy);
    EXPECT_EQ(a.pose.rotation, b.pose.rotation);
    EXPECT_EQ(a.pose.centre, b.pose.centre);
    EXPECT_EQ(a.max_depth, b.max_depth);
    EXPECT_EQ(a.neighbours.size(), b.neighbours.size());
  }
  EXPECT_EQ(again.images[0].neighbours[0].score, 5);
  EXPECT_EQ(again.points[0].views.size(), 3u);
  EXPECT_EQ(again.points[1].position, scene.points[1].position);
  EXPECT_EQ(again.point_normals, scene.point_normals);
  EXPECT_EQ(again.point_colors, scene.point_colors);
  ASSERT_TRUE(again.region);
  EXPECT_EQ(again.region->half_extent, scene.region->half_extent);
  // A second copy is identical: the bytes depend only on the scene.
  write_mvs(folder_ / "third.mvs", again, folder_);
  EXPECT_EQ(read_file(folder_ / "third.mvs"), read_file(copy));
}

TEST_F(MvsTest, StoresPathsBelowTheWorkingFolderRelatively) {
  Scene scene = read({});
  scene.images[1].path = "/elsewhere/b.png";
  write_mvs(file_, scene, folder_);
  const std::string bytes = read_file(file_);
  EXPECT_EQ(bytes.find(folder_.string()), std::string::npos);
  // Photographs beside the scene are found from any working folder.
  EXPECT_EQ(read_mvs(file_, "/other").images[0].path, (folder_ / "images/a.png").string());
  std::filesystem::remove(folder_ / "images/a.png");
  const Scene moved = read_mvs(file_, "/other");
  EXPECT_EQ(moved.images[0].path, "/other/images/a.png");
  EXPECT_EQ(moved.images[1].path, "/elsewhere/b.png");
}

TEST_F(MvsTest, RefusesToWriteWhatCannotBeRead) {
  Scene scene = read({});
  scene.points[0].views[0].image = 9;
  EXPECT_THAT(error_of([&] { write_mvs(file_, scene, folder_); }), HasSubstr("image 9"));
  EXPECT_THAT(error_of([&] { write_mvs(file_, Scene{}, folder_); }), HasSubstr("two images"));
}

}  // namespace
}  // namespace axial::io
