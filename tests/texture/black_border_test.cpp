// SPDX-License-Identifier: GPL-3.0-or-later
// Black borders (survey/black_border.h) in texturing.
#include "survey/black_border.h"

#include <gtest/gtest.h>

#include "texture/painted_room.h"

namespace axial::texture {
namespace {

TEST(BlackBorder, FacesDoNotGetTheColourOfTheBorder) {
  test::Room room = test::photograph_room(6);
  for (auto& [color, usable] : room.images) {
    color.rowRange(0, 40).setTo(cv::Scalar(0, 0, 0));
    color.colRange(200, 240).setTo(cv::Scalar(0, 0, 0));
  }
  const auto black = [&](bool detect) {
    for (auto& [color, usable] : room.images)
      usable = detect ? survey::outside_black_border(color) : cv::Mat1b();
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
