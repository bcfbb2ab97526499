// SPDX-License-Identifier: GPL-3.0-or-later
#include "picture/dmap_pictures.h"

#include <gtest/gtest.h>

#include "io/images/image.h"
#include "support/empty_folder.h"

namespace axial::picture {
namespace {

namespace fs = std::filesystem;

// A slope from 1 m (left) to 3 m (right), facing the camera, with a hole in its middle.
DepthMap slope() {
  constexpr int kWidth = 21, kHeight = 5;
  DepthMap map;
  map.depth.create(kHeight, kWidth);
  map.normal = cv::Mat3f(kHeight, kWidth, cv::Vec3f(0, 0, -1));
  for (int v = 0; v < kHeight; ++v)
    for (int u = 0; u < kWidth; ++u) map.depth(v, u) = 1 + 0.1f * static_cast<float>(u);
  map.depth(2, 10) = 0;
  map.normal(2, 10) = {0, 0, 0};
  map.confidence = map.depth.clone();
  return map;
}

TEST(DmapPictures, ShowsWhatIsThereAndBlackElsewhere) {
  const fs::path folder = test::empty_folder();
  write_dmap_pictures(folder / "depth0007.dmap", slope());
  const cv::Mat3b depth = io::read_color_image(folder / "depth0007.png");
  const cv::Mat3b normal = io::read_color_image(folder / "depth0007.normal.png");
  const cv::Mat3b confidence = io::read_color_image(folder / "depth0007.confidence.png");

  ASSERT_EQ(depth.size(), cv::Size(21, 5));
  for (const cv::Mat3b& picture : {depth, normal, confidence})
    EXPECT_EQ(picture(2, 10), cv::Vec3b(0, 0, 0));
  const cv::Vec3b near = depth(0, 0), far = depth(0, 20);
  EXPECT_GT(near[0], near[2]);
  EXPECT_GT(far[2], far[0]);
  EXPECT_EQ(normal(0, 0), cv::Vec3b(255, 128, 128));
  for (int u = 1; u < 21; ++u) EXPECT_GT(confidence(0, u)[0], confidence(0, u - 1)[0]);
  fs::remove_all(folder);
}

TEST(DmapPictures, TakesMapsThatAreFlatOrEmpty) {
  const fs::path folder = test::empty_folder();
  DepthMap map = slope();
  map.depth = 2.0f;
  map.confidence.release();
  write_dmap_pictures(folder / "flat.dmap", map);
  EXPECT_NE(io::read_color_image(folder / "flat.png")(0, 0), cv::Vec3b(0, 0, 0));
  EXPECT_FALSE(fs::exists(folder / "flat.confidence.png"));
  map.depth = 0.0f;
  write_dmap_pictures(folder / "empty.dmap", map);
  EXPECT_EQ(cv::countNonZero(io::read_color_image(folder / "empty.png").reshape(1)), 0);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace axial::picture
