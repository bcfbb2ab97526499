// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture/colors/leveling.h"

#include <gtest/gtest.h>

#include "texture/colors/chart_field.h"
#include "texture/faces/adjacency.h"
#include "texture/painted_room.h"

namespace axial::texture {
namespace {

// The mean difference of colours on both sides of edges between faces of different charts, at the
// middle of the edge [grey levels].
double mean_step(const TexturedMesh& mesh) {
  double sum = 0;
  std::size_t count = 0;
  for (const FacePair& pair : face_pairs(mesh.mesh.faces)) {
    const auto place = [&](std::uint32_t face) {
      Eigen::Vector3f weights = Eigen::Vector3f::Zero();
      for (std::size_t k = 0; k < 3; ++k)
        if (mesh.mesh.faces[face][k] == pair.from || mesh.mesh.faces[face][k] == pair.to)
          weights[static_cast<int>(k)] = 0.5f;
      const auto& uv = mesh.uv[face];
      return std::pair(
          Eigen::Vector2f(weights[0] * uv[0] + weights[1] * uv[1] + weights[2] * uv[2]),
          test::color_at(mesh, face, weights));
    };
    const auto [at_a, a] = place(pair.a);
    const auto [at_b, b] = place(pair.b);
    if (!a || !b || (at_a - at_b).norm() < 0.01f) continue;  // one chart
    sum += (*a - *b).cwiseAbs().mean();
    ++count;
  }
  EXPECT_GT(count, 50u);
  return sum / static_cast<double>(count);
}

TexturedMesh room_of_exposures(bool global, bool local) {
  const test::Room room = test::photograph_room(6, {0.8f, 1, 1.15f, 0.9f, 1.05f, 0.85f});
  Options options;
  options.leveling.global = global;
  options.leveling.local = local;
  return texture_mesh(test::refined(test::room_mesh(), 4), room.views, room.source(), options);
}

// Exposures differ by up to 44 %, which is 50 levels in a colour of 128.
TEST(Leveling, SeamsOfDifferentExposuresVanish) {
  EXPECT_GT(mean_step(room_of_exposures(false, false)), 10);
  EXPECT_LT(mean_step(room_of_exposures(true, false)), 5);
  EXPECT_LT(mean_step(room_of_exposures(true, true)), 2.5);
  EXPECT_LT(mean_step(room_of_exposures(false, true)), 5);
}

// Where all photographs agree there is nothing to correct.
TEST(Leveling, ColoursOfEqualExposuresStay) {
  const test::Room room = test::photograph_room(6);
  const Mesh mesh = test::refined(test::room_mesh(), 4);
  const TexturedMesh plain = texture_mesh(mesh, room.views, room.source(), test::plain_options());
  const TexturedMesh levelled = texture_mesh(mesh, room.views, room.source());
  ASSERT_EQ(plain.textures.size(), levelled.textures.size());
  EXPECT_LT(cv::mean(cv::abs(cv::Mat(plain.textures[0] - levelled.textures[0])))[0], 0.5);
}

// In a strip across a long band, the harmonic correction falls linearly from the seam to zero.
TEST(ChartField, CorrectionFallsLinearlyInTheStrip) {
  ChartField field({60, 40});
  const std::array<Eigen::Vector3f, 3> zero{Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero(),
                                            Eigen::Vector3f::Zero()};
  field.add_triangle({Eigen::Vector2f(-200, -1), {300, -1}, {-200, 300}}, zero);
  std::vector<ChartField::Sample> seam;
  for (int x = 0; x < 60; ++x)
    seam.push_back({{static_cast<float>(x), 0}, Eigen::Vector3f(20, 40, -60)});
  field.add_strip(seam, 20);
  cv::Mat3b texture(40, 60, cv::Vec3b(100, 100, 100));
  field.add_to(texture);
  for (int y = 0; y < 40; ++y) {
    const double share = std::max(0.0, 1 - y / 20.0);
    for (int c = 0; c < 3; ++c) {
      const double expected = 100 + share * (c == 0 ? 20 : c == 1 ? 40 : -60);
      EXPECT_NEAR(texture(y, 30)[c], expected, 1) << y;
    }
  }
}

TEST(ChartField, ValuesAreLinearInTriangles) {
  ChartField field({30, 30});
  field.add_triangle(
      {Eigen::Vector2f(2, 3), {25, 5}, {7, 27}},
      {Eigen::Vector3f(10, 0, 0), Eigen::Vector3f(0, 50, 0), Eigen::Vector3f(0, 0, 90)});
  cv::Mat3b texture(30, 30, cv::Vec3b(100, 100, 100));
  field.add_to(texture);
  // The centre of gravity of the triangle is (11.33, 11.67).
  EXPECT_EQ(texture(12, 11)[0], 103);
  EXPECT_NEAR(texture(12, 11)[1], 116.4, 1);
  EXPECT_NEAR(texture(12, 11)[2], 131, 2);
  EXPECT_EQ(texture(29, 29), cv::Vec3b(100, 100, 100));
}

}  // namespace
}  // namespace axial::texture
