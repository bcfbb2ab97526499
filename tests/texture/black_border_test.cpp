// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture/black_border.h"

#include <gtest/gtest.h>

#include "texture/painted_room.h"

namespace axial::texture {
namespace {

TEST(BlackBorder, OnlyBlackAtTheEdgeIsLeftOut) {
  cv::Mat3b image(60, 80, cv::Vec3b(90, 100, 110));
  image(cv::Rect(0, 0, 80, 7)).setTo(cv::Scalar(1, 0, 3));     // compression changes black a little
  image(cv::Rect(30, 30, 20, 10)).setTo(cv::Scalar(0, 0, 0));  // a black thing
  const cv::Mat1b usable = outside_black_border(image);
  ASSERT_EQ(usable.size(), image.size());
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 80; ++x) EXPECT_EQ(usable(y, x), y < 10 ? 0 : 255) << x << " " << y;
}

TEST(BlackBorder, AnImageWithoutBorderIsUsedAsAWhole) {
  const cv::Mat3b image(60, 80, cv::Vec3b(9, 10, 11));
  EXPECT_TRUE(outside_black_border(image).empty());
}

TEST(BlackBorder, FacesDoNotGetTheColourOfTheBorder) {
  test::Room room = test::photograph_room(6);
  for (auto& [color, usable] : room.images) {
    color.rowRange(0, 40).setTo(cv::Scalar(0, 0, 0));
    color.colRange(200, 240).setTo(cv::Scalar(0, 0, 0));
  }
  const auto black = [&](bool detect) {
    for (auto& [color, usable] : room.images)
      usable = detect ? outside_black_border(color) : cv::Mat1b();
    const TexturedMesh mesh = texture_mesh(test::refined(test::room_mesh(), 4), room.views,
                                           room.source(), test::plain_options());
    std::size_t count = 0;
    test::for_each_color(mesh, [&](std::size_t, const Eigen::Vector3f& c, const Eigen::Vector3d&) {
      if (c.maxCoeff() < 40) ++count;
    });
    return count;
  };
  EXPECT_GT(black(false), 50u);
  EXPECT_EQ(black(true), 0u);
}

}  // namespace
}  // namespace axial::texture
