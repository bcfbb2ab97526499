// SPDX-License-Identifier: GPL-3.0-or-later
// The stated standard deviations of measured polygons: noisy meshes of surfaces with closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <random>

#include "geometry/vertex_bends.h"
#include "map/area_table.h"
#include "support/grid_mesh.h"

namespace axial::map {
namespace {

// The graph of a function on [-1, 1]^2 with vertices that are shifted in their cells, and with
// noise along the normal of the graph, if its slopes are small.
Mesh noisy_graph(int steps, double noise, unsigned seed,
                 const std::function<double(double, double)>& height) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> shift(-0.25, 0.25);
  return test::grid_mesh(steps, [&](int i, int j) {
    const double x = -1 + 2.0 * (i + shift(random)) / steps,
                 y = -1 + 2.0 * (j + shift(random)) / steps;
    return Eigen::Vector3d(x, y, height(x, y) + noise * normal(random));
  });
}

Area circle(double radius) {
  constexpr int kCorners = 720;
  Area area{"disc", {{{}}}};
  for (int i = 0; i < kCorners; ++i)
    area.parts[0][0].push_back(radius *
                               Eigen::Vector2d(std::cos(2 * std::numbers::pi * i / kCorners),
                                               std::sin(2 * std::numbers::pi * i / kCorners)));
  return area;
}

std::map<std::string, AreaValue> measured(const Mesh& mesh, const Area& area) {
  const Mesh smooth = geometry::smoothed(mesh);
  const Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::map<std::string, AreaValue> values;
  for (const AreaValue& value : values_of(
           {area, AreaMeter(mesh, origin).measure(area), AreaMeter(smooth, origin).measure(area)},
           0))
    values[value.name] = value;
  return values;
}

// Counts the draws whose truth is within two standard deviations.
void expect_covered(double noise, const std::function<double(double, double)>& height,
                    const Area& area, const std::map<std::string, double>& truth) {
  constexpr int kDraws = 20, kSteps = 60;
  std::map<std::string, int> covered;
  std::map<std::string, double> stated;
  for (unsigned seed = 1; seed <= kDraws; ++seed) {
    const auto found = measured(noisy_graph(kSteps, noise, seed, height), area);
    for (const auto& [name, value] : truth) {
      const AreaValue& one = found.at(name);
      covered[name] += std::abs(one.value - value) <= 2 * one.sigma + 1e-6;  // vertices are floats
      stated[name] += one.sigma / kDraws;
    }
  }
  for (const auto& [name, value] : truth) {
    // 95 % of the draws.
    EXPECT_GE(covered[name], 19) << name;
    // Larger errors would cover everything: the noise makes 1 % of the area, and a polygon of
    // 2.5 m^2 has a volume of 0.005 m^3 for each standard deviation. The mean of a thousand heights
    // is known to a thirtieth of the noise.
    EXPECT_LT(stated[name], name == "mean_height_m" ? noise / 4 : 0.03) << name;
  }
}

// A slope with noise of a fifteenth of the vertices' distance.
TEST(AreaSigmas, OfANoisySlopeCoverTheTruth) {
  const double x = 0.3, y = -0.2, area = 360 * 0.64 * std::sin(2 * std::numbers::pi / 720);
  const double steep = std::sqrt(1 + x * x + y * y);
  expect_covered(2e-3, [&](double u, double v) { return x * u + y * v; }, circle(0.8),
                 {{"planar_m2", area},
                  {"seen_m2", area * steep},
                  {"surface_m2", area * steep},
                  {"rugosity", steep},
                  {"rugosity_on_slope", 1},
                  {"mean_height_m", 0},
                  {"volume_above_m3", 0},
                  {"volume_below_m3", 0}});
}

// A paraboloid 0.1 m high on level ground, a polygon far around it, and one just around it.
TEST(AreaSigmas, OfANoisyMoundCoverTheTruth) {
  const double high = 0.1, base = 0.6;
  const auto mound = [&](double x, double y) {
    return std::max(0.0, high * (1 - (x * x + y * y) / (base * base)));
  };
  const double volume = std::numbers::pi / 2 * high * base * base, slope = 2 * high / base;
  const double of_mound = std::numbers::pi * base * base * 2 / 3 *
                          (std::pow(1 + slope * slope, 1.5) - 1) / (slope * slope);
  for (const double radius : {0.6, 0.9}) {
    const double area = 360 * radius * radius * std::sin(2 * std::numbers::pi / 720);
    const double seen = of_mound + area - std::numbers::pi * base * base;
    expect_covered(2e-3, mound, circle(radius),
                   {{"seen_m2", seen},
                    {"rugosity", seen / area},
                    {"mean_height_m", volume / area},
                    {"volume_above_m3", volume},
                    {"volume_below_m3", 0}});
  }
}

// The noise of the vertices is found. A smoothed vertex is the mean of itself and six neighbours.
TEST(AreaSigmas, NoiseIsEstimated) {
  const auto level = [](double, double) { return 0.0; };
  const double sigma = 1e-3;
  const Mesh mesh = noisy_graph(60, sigma, 7, level);
  const AreaMeasures found = AreaMeter(mesh, Eigen::Vector3d::Zero()).measure(circle(0.8));
  // 1,800 vertices: the standard deviation of their spread is 1.7 %, and neighbours share errors.
  EXPECT_NEAR(found.noise, sigma, 0.1 * sigma);
  EXPECT_NEAR(found.spacing, 2.0 / 60, 0.05 * 2.0 / 60);
  double sum = 0;
  const Mesh smooth = geometry::smoothed(mesh);
  for (const Eigen::Vector3f& vertex : smooth.vertices) sum += std::pow(vertex.z(), 2);
  // The vertices at the rim have fewer neighbours.
  EXPECT_NEAR(std::sqrt(sum / static_cast<double>(smooth.vertices.size())), sigma / std::sqrt(7),
              0.1 * sigma);
}

}  // namespace
}  // namespace axial::map
