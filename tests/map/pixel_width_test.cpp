// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/pixel_width.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/error_of.h"
#include "texture/painted_room.h"
#include "worlds/height_field.h"
#include "worlds/ports.h"

namespace axial::map {
namespace {

PosedCamera looking_down(double height, double focal) {
  return test::camera_above({0, 0, height}, 1000, 1000, focal);
}

TEST(PixelWidth, IsDistanceByFocalLength) {
  const Mesh mesh = test::height_field({-1, -1}, {1, 1}, 3, [](double, double) { return 0.5; });
  const std::vector<PosedCamera> photos{looking_down(4.5, 800), looking_down(2.5, 800)};
  EXPECT_NEAR(median_pixel_width(mesh, photos), 2.0 / 800, 1e-9);
  EXPECT_NEAR(median_pixel_width(mesh, std::span(photos).first(1)), 4.0 / 800, 1e-9);
}

// Behind a flat port, an object near the axis looks larger. By Snell's law for small angles the
// water of depth d acts like air of depth d / n.
TEST(PixelWidth, IsThatOfTheCameraBehindThePort) {
  const Mesh mesh =
      test::height_field({-.002, -.002}, {.002, .002}, 1, [](double, double) { return 0.; });
  PosedCamera photo = looking_down(2, 800);
  photo.camera.port = test::flat_port(0.05, 0.01);
  const double apparent = 0.05 + 0.01 / 1.5 + (2 - 0.06) / 1.333;
  EXPECT_NEAR(median_pixel_width(mesh, std::vector{photo}), apparent / 800, 1e-5 * apparent / 800);
}

TEST(PixelWidth, IsRoundedToTwoDigits) {
  EXPECT_DOUBLE_EQ(rounded_width(0.0029249), 0.0029);
  EXPECT_DOUBLE_EQ(rounded_width(0.00998), 0.01);
  EXPECT_DOUBLE_EQ(rounded_width(1.26), 1.3);
  EXPECT_DOUBLE_EQ(rounded_width(1249), 1200);
}

TEST(PixelWidth, PhotographsFromBelowDoNotCount) {
  Mesh mesh = test::height_field({-1, -1}, {1, 1}, 3, [](double, double) { return 0.5; });
  for (auto& face : mesh.faces) std::swap(face[0], face[1]);
  EXPECT_THAT(
      test::error_of([&] { median_pixel_width(mesh, std::vector{looking_down(4.5, 800)}); }),
      testing::HasSubstr("no photograph shows the mesh"));
}

}  // namespace
}  // namespace axial::map
