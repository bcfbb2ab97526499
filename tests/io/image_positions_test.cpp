// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cameras/image_positions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/wrong_input.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using testing::ElementsAre;
using testing::HasSubstr;

using Numbers = std::vector<std::size_t>;

TEST(ImageLabels, AreEndsOfPaths) {
  const std::vector<std::string> paths{"/a/left/1.jpg", "/a/right/1.jpg", "/a/21.jpg"};
  const ImageLabels labels(paths);
  EXPECT_EQ(labels.find("left/1.jpg").images, Numbers{0});
  EXPECT_EQ(labels.find("1.jpg").images, (Numbers{0, 1}));
  EXPECT_EQ(labels.find("./left/../right/1.jpg").images, Numbers{1});
  EXPECT_EQ(labels.find("/a/right/1.jpg").images, Numbers{1});
  EXPECT_EQ(labels.find("21.jpg").images, Numbers{2});
  for (const char* other : {"ft/1.jpg", "below/1.jpg", "left", "1.jpg/", "", "a/22.jpg"})
    EXPECT_TRUE(labels.find(other).images.empty()) << other;
}

TEST(ImageLabels, MayBeWrittenAsOtherProgramsDo) {
  const std::vector<std::string> paths{"images/dive1/IMG_1.jpg", "images/dive2/IMG_1.jpg",
                                       "images/dive1/IMG_2.JPG", "DSC 3.tif"};
  const ImageLabels labels(paths);
  for (const char* label :
       {"dive1/img_1.JPG", "dive1\\IMG_1.jpg", "C:\\Users\\me\\dive1\\IMG_1.JPG",
        "/home/me/dive1/IMG_1.jpg", "dive1/IMG_1", "dive1/IMG_1.DNG"})
    EXPECT_EQ(labels.find(label).images, Numbers{0}) << label;
  for (const char* label : {"IMG_2", "img_2.jpg", "D:/x/IMG_2.JPG"})
    EXPECT_EQ(labels.find(label).images, Numbers{2}) << label;
  for (const char* label : {"dsc 3", "raw/DSC 3.tif", "DSC 3.ARW"})
    EXPECT_EQ(labels.find(label).images, Numbers{3}) << label;
  EXPECT_EQ(labels.find("IMG_1").images, (Numbers{0, 1}));
  EXPECT_TRUE(labels.find("dive3/IMG_2.JPG").images.empty());
  EXPECT_TRUE(labels.find("DSC 3.txt").images.empty());
}

ImagePositions read(const std::string& text, const std::vector<std::string>& paths) {
  const fs::path folder = test::empty_folder();
  test::put(folder / "known.csv", text);
  ImagePositions positions = positions_of_images(folder / "known.csv", paths, "the scene");
  fs::remove_all(folder);
  return positions;
}

TEST(ImagePositions, BelongToTheBestLabel) {
  const ImagePositions positions =
      read("a.dng,9,9,9\na.JPG,1,2,3\nb,4,5,6\nlost,7,8,9\n", {"x/a.jpg", "x/b.jpg"});
  ASSERT_EQ(positions.found.size(), 2u);
  EXPECT_EQ(positions.found[0].image, 0u);
  EXPECT_EQ(positions.found[0].line, 2);
  EXPECT_EQ(positions.found[1].position, Eigen::Vector3d(4, 5, 6));
  EXPECT_THAT(positions.absent,
              ElementsAre(HasSubstr("known.csv:1: the scene has no image 'a.dng'"),
                          HasSubstr("known.csv:4: the scene has no image 'lost'")));
}

TEST(ImagePositions, AmbiguousLabelsNameBothImages) {
  EXPECT_THAT(error_of([] {
                read("b 0 0 0\na 1 2 3\n", {"a.jpg", "a.png", "b.jpg"});
              }),
              HasSubstr("known.csv:2: 'a' can be a.jpg or a.png; give more of its path"));
  EXPECT_THAT(error_of([] { read("A.jpg 1 2 3\nA.JPG 1 2 3\n", {"a.jpg"}); }),
              HasSubstr("known.csv:2: A.JPG occurs twice"));
}

}  // namespace
}  // namespace axial::io
