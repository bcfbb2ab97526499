// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/water.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "simulate/light.h"
#include "simulate/spectrum.h"
#include "simulate/underwater.h"
#include "support/error_of.h"

namespace axial::simulate {
namespace {

using testing::HasSubstr;

TEST(Spectrum, GreyIsFlatAndColorsComeBack) {
  for (const float grey : {0.05f, 0.4f, 0.95f}) {
    const Spectrum flat = reflectance_of({grey, grey, grey});
    EXPECT_LT((flat - grey).abs().maxCoeff(), 1e-5f);
  }
  for (const Eigen::Vector3f& color :
       {Eigen::Vector3f(0.5f, 0.4f, 0.3f), {0.2f, 0.3f, 0.35f}, {0.3f, 0.2f, 0.15f}})
    EXPECT_LT((color_of(reflectance_of(color)) - color).norm(), 1e-5f);
  // Not all colours have a reflectance.
  const Spectrum red = reflectance_of({1, 0, 0});
  EXPECT_GE(red.minCoeff(), 0.002f);
  EXPECT_LE(red.maxCoeff(), 1.0f);
  EXPECT_NEAR(daylight().mean(), 1, 1e-5);
  EXPECT_NEAR(white_led().mean(), 1, 1e-5);
}

TEST(Water, HasTheValuesOfTheTable) {
  const Water clear = jerlov_water("IB"), coast = jerlov_water("7C", 0.5);
  EXPECT_FLOAT_EQ(clear.daylight_loss[0], 0.051f);                     // 400 nm
  EXPECT_FLOAT_EQ(clear.daylight_loss[5], 0.042f);                     // 500 nm
  EXPECT_FLOAT_EQ(clear.daylight_loss[15], 0.580f);                    // 700 nm
  EXPECT_FLOAT_EQ(coast.daylight_loss[1], 0.2f * 1.6f + 0.8f * 1.2f);  // 420 nm
  EXPECT_NEAR(coast.scattering[7], 0.5 * 550 / 540, 1e-6);
  // Without scattering, the absorption is K_d times the cosine of the sun's rays.
  EXPECT_FLOAT_EQ(jerlov_water("IB", 0).absorption[5], 0.86f * 0.042f);
  EXPECT_THAT(test::error_of([] { jerlov_water("X"); }), HasSubstr("water is 'X'"));
  EXPECT_THAT(test::error_of([] { jerlov_water("I", -1); }), HasSubstr("scattering is -1"));
}

TEST(Water, ScattersAllLightIntoTheSphere) {
  constexpr int kSteps = 20000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i)
    sum += phase(-1 + (i + 0.5) * 2 / kSteps) * 2 * std::numbers::pi * 2 / kSteps;
  EXPECT_NEAR(sum, 1, 1e-4);
}

// A white wall that fills the picture, `distance` from the glass of a camera that looks down.
class Wall : public testing::Test {
 protected:
  static TriangleMesh plane(double z) {
    return grid_mesh(2, 2, false, [z](std::size_t r, std::size_t c) {
      return Eigen::Vector3d(r == 0 ? -50 : 50, c == 0 ? -50 : 50, z);
    });
  }

  // The radiance (R G B) at the centre of the picture.
  static Eigen::Vector3d seen(const AnyWater& water, double distance, float grey = 0.5f) {
    const TriangleMesh mesh = plane(0);
    const RayScene scene(mesh);
    const auto normals = vertex_normals(mesh);
    const Shader albedo = [grey](const SurfacePoint&) { return Eigen::Vector3f(grey, grey, grey); };
    View view;
    view.rotation = Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()).matrix();
    Port port;
    port.distance = 0.01;
    port.thickness = 0.005;
    port.n_glass = 1.5;
    port.n_water = 1.33;
    view.centre = {0, 0, distance + port.distance + port.thickness};
    const LitImage image = render_underwater({scene, mesh, normals, albedo}, water,
                                             make_lens(41, 31, 20), port, view, 1);
    const cv::Vec3f centre = image.radiance(15, 20);
    return {centre[2], centre[1], centre[0]};
  }

  static SpectralWater water_with(double absorption, double scattering) {
    SpectralWater lit{jerlov_water("I"), {}};
    lit.water.absorption.setConstant(static_cast<float>(absorption));
    lit.water.scattering.setConstant(static_cast<float>(scattering));
    lit.water.daylight_loss.setZero();
    return lit;
  }
};

TEST_F(Wall, PlainWaterFollowsItsFormula) {
  const PlainWater water{{0.4f, 0.15f, 0.1f}, {0.3f, 0.12f, 0.09f}, {0.02f, 0.2f, 0.25f}};
  const Eigen::Vector3d color = seen(water, 2);
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(
        color[k],
        0.5 * std::exp(-2.0 * water.a[k]) + water.veil[k] * (1 - std::exp(-2.0 * water.b[k])),
        1e-6);
}

TEST_F(Wall, DaylightIsLostByWavelengthAndDepth) {
  SpectralWater lit{jerlov_water("IB", 0.0), {}};
  lit.light.sun.depth = 4;
  const Eigen::Vector3d color = seen(lit, 3);
  // Without scattering, every band is lost on its own, down and back.
  const Spectrum seen_light =
      0.5f * daylight() * (-4 * lit.water.daylight_loss - 3 * lit.water.absorption).exp();
  EXPECT_LT((color - color_of(seen_light).cast<double>()).norm(), 1e-5);
  EXPECT_LT(color.x(), 0.5 * color.z());
}

TEST_F(Wall, TheVeilOfEvenWaterSaturatesExponentially) {
  // In light that does not change with the depth, the veil is V (1 - exp(-c' d)), c' without the
  // light that is only blurred. The integral of 24 steps is exact to (c' d / 24)^2 / 24.
  const SpectralWater lit = water_with(0.1, 0.4);
  const double rate = 0.1 + (1 - lit.water.blurred) * 0.4;
  const Eigen::Vector3d white = color_of(daylight()).cast<double>();
  const auto veil = [&](double way) {  // the blackest surface reflects 0.002
    return Eigen::Vector3d(seen(lit, way, 0) - 0.002 * std::exp(-rate * way) * white);
  };
  const Eigen::Vector3d near = veil(1), far = veil(4);
  EXPECT_NEAR(far.y() / near.y(), (1 - std::exp(-4 * rate)) / (1 - std::exp(-rate)), 2e-3);
}

TEST_F(Wall, BlurredLightIsNotLost) {
  // The wall is even, so that its blurred image is the wall itself: the loss is c', not c.
  const SpectralWater lit = water_with(0.1, 0.4);
  const double rate = 0.1 + (1 - lit.water.blurred) * 0.4;
  const Eigen::Vector3d lost = seen(lit, 2, 0.9f) - seen(lit, 2, 0);
  const Eigen::Vector3d white = color_of(daylight()).cast<double>();
  // Black reflects 0.002.
  EXPECT_LT((lost - (0.9 - 0.002) * std::exp(-2 * rate) * white).norm(), 1e-3);
}

TEST_F(Wall, ALampFallsWithTheSquareOfTheDistance) {
  SpectralWater lit = water_with(0, 0);
  lit.light.lamps = {Lamp{}};
  const Eigen::Vector3d white = color_of(white_led()).cast<double>();
  for (const double distance : {0.5, 1.0, 2.0}) {
    const double way = distance + 0.015;  // the lamp is at the camera's centre
    EXPECT_LT((seen(lit, distance) - 0.5 / (way * way) * white).norm(), 2e-3 / (way * way));
  }
  lit.water = water_with(0.3, 0).water;
  const Eigen::Vector3d color = seen(lit, 1);
  EXPECT_LT((color - 0.5 / (1.015 * 1.015) * std::exp(-0.3 * 2.015) * white).norm(), 1e-3);
  // At the angle `half_angle` from its axis, half the light is left.
  lit = water_with(0, 0);
  lit.light.lamps = {Lamp{{0, 0, 0}, Eigen::Vector3d(std::sin(0.7), 0, std::cos(0.7)), 0.7, 1}};
  EXPECT_LT((seen(lit, 1) - 0.25 / (1.015 * 1.015) * white).norm(), 2e-3);
}

TEST(Photograph, CurvesKeepBlackAndWhiteAndOrder) {
  cv::Mat3f ramp(1, 101);
  for (int i = 0; i <= 100; ++i) ramp(0, i) = cv::Vec3f::all(static_cast<float>(i) / 100);
  for (const Response response : {Response::linear, Response::srgb, Response::camera}) {
    const cv::Mat3f values = photograph_of(ramp, {1, 1, 1}, response);
    EXPECT_NEAR(values(0, 0)[0], 0, 1e-6);
    EXPECT_NEAR(values(0, 100)[0], 1, 1e-6);
    for (int i = 0; i < 100; ++i) EXPECT_LT(values(0, i)[0], values(0, i + 1)[0]);
  }
  EXPECT_NEAR(photograph_of(ramp, {1, 1, 1}, Response::srgb)(0, 50)[1], 0.7354, 1e-4);
  EXPECT_NEAR(photograph_of(ramp, {2, 1, 1}, Response::linear)(0, 80)[0], 1, 1e-6);
  EXPECT_THAT(test::error_of([] { parse_response("log"); }), HasSubstr("response is 'log'"));
}

TEST(Photograph, ExposureLeavesRoomForTheBrightest) {
  cv::Mat3f even(10, 10, cv::Vec3f(0.1f, 0.2f, 0.05f));
  const std::vector<cv::Mat3f> images{even};
  EXPECT_NEAR(exposure(images, {1, 1, 1}), 4, 1e-5);
  EXPECT_NEAR(exposure(images, {4, 1, 1}), 2, 1e-5);
  EXPECT_EQ(exposure(std::vector<cv::Mat3f>{cv::Mat3f(2, 2, cv::Vec3f(0, 0, 0))}, {1, 1, 1}), 1);
}

}  // namespace
}  // namespace axial::simulate
