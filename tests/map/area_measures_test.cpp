// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/area_measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "support/grid_mesh.h"

namespace axial::map {
namespace {

constexpr double kPi = std::numbers::pi;

// The graph of a function on the square [-1, 1]^2, in squares of two triangles.
Mesh graph(int steps, const std::function<double(double, double)>& height) {
  return test::grid_mesh(steps, [&](int i, int j) {
    const double x = -1 + 2.0 * i / steps, y = -1 + 2.0 * j / steps;
    return Eigen::Vector3d(x, y, height(x, y));
  });
}

Area disc(const Eigen::Vector2d& centre, double radius, int corners = 720) {
  Area area{"disc", {{{}}}};
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * kPi * i / corners;
    area.parts[0][0].push_back(centre + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return area;
}

TEST(AreaMeasures, OfAPlaneAreExact) {
  const Mesh mesh = graph(37, [](double x, double y) { return 0.75 * x - 0.5 * y + 0.25; });
  const Eigen::Vector3d origin(500000, 4000000, -20);
  const Area square{"square",
                    {{{{499999.5, 3999999.5},
                       {500000.5, 3999999.5},
                       {500000.5, 4000000.5},
                       {499999.5, 4000000.5}},
                      {{499999.9, 4000000}, {500000.1, 4000000}, {500000, 4000000.2}}}}};
  const AreaMeasures found = AreaMeter(mesh, origin).measure(square);
  const double steepness = std::sqrt(1 + 0.75 * 0.75 + 0.5 * 0.5);
  // Vertices are floats, and coordinates of UTM have 1e-9 m.
  EXPECT_NEAR(found.polygon, 0.98, 1e-8);
  EXPECT_NEAR(found.planar, 0.98, 1e-6);
  EXPECT_NEAR(found.rugosity(), steepness, 1e-6);
  EXPECT_NEAR(found.rugosity_on_slope(), 1, 1e-6);
  EXPECT_NEAR(found.slope_degrees(), std::atan(std::hypot(0.75, 0.5)) * 180 / kPi, 1e-4);
  // The plane falls to -x and +y: to the north-west, nearer to the west.
  EXPECT_NEAR(found.aspect_degrees(), 360 - std::atan2(0.75, 0.5) * 180 / kPi, 1e-3);
  EXPECT_NEAR(found.roughness(), 0, 1e-4);
  EXPECT_NEAR(found.highest - found.lowest, 1.25, 1e-6);
  EXPECT_NEAR(found.above, 0, 1e-6);
  EXPECT_NEAR(found.below, 0, 1e-6);
  EXPECT_EQ(found.rim, 1);
}

// A cap of a sphere of radius 1.25, 0.5 high, over a disc of radius 1: closed forms.
TEST(AreaMeasures, OfACapAreThoseOfTheSphere) {
  const double radius = 1.25, high = 0.5;
  const Mesh mesh = graph(400, [&](double x, double y) {
    return std::sqrt(std::max(0.0, radius * radius - x * x - y * y)) - (radius - high);
  });
  const AreaMeasures found = AreaMeter(mesh, Eigen::Vector3d::Zero()).measure(disc({0, 0}, 0.999));
  // The sagitta of an edge of 5 mm is edge^2 / (8 radius) = 2.5e-6 m, so that heights are too low
  // by up to 5e-6 m on faces, and volumes by up to 2e-5 m^3. Slopes up to 1.3 at the rim make that
  // an area of 1e-4 m^2. The disc has 720 corners and is too small by 4e-5 m^2.
  const double base = 0.999, rim = std::sqrt(radius * radius - base * base) - (radius - high);
  const double cap = high - rim;
  EXPECT_NEAR(found.surface, 2 * kPi * radius * cap, 2e-4);
  EXPECT_NEAR(found.planar, kPi * base * base, 1e-4);
  EXPECT_NEAR(found.above, kPi * cap * cap * (3 * radius - cap) / 3, 3e-4);
  EXPECT_NEAR(found.below, 0, 1e-5);
  EXPECT_NEAR(found.slope_degrees(), 0, 1e-2);
  EXPECT_NEAR(found.highest, high, 1e-6);
}

// A square of width 1 at a height, at which side of it is above.
void add_square(Mesh& mesh, float height, bool is_up, float tilt = 0) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const auto& [x, y] : {std::pair(-0.5f, -0.5f), {0.5f, -0.5f}, {0.5f, 0.5f}, {-0.5f, 0.5f}})
    mesh.vertices.emplace_back(x, y, height + tilt * x);
  for (const auto& [a, b, c] : {std::array{0u, 1u, 2u}, {0u, 2u, 3u}})
    mesh.faces.push_back(is_up ? std::array{first + a, first + b, first + c}
                               : std::array{first + a, first + c, first + b});
}

const Area kWide{"all", {{{{-0.9, -0.9}, {0.9, -0.9}, {0.9, 0.9}, {-0.9, 0.9}}}}};

// A table over the ground, with and without its lower side: what is below it is not seen.
TEST(AreaMeasures, ATableHidesTheGround) {
  for (const bool has_lower_side : {true, false}) {
    Mesh mesh = graph(2, [](double, double) { return 0.0; });
    add_square(mesh, 0.4f, true);
    if (has_lower_side) add_square(mesh, 0.3f, false);
    const AreaMeasures found = AreaMeter(mesh, Eigen::Vector3d::Zero()).measure(kWide);
    EXPECT_NEAR(found.planar, 1.8 * 1.8, 1e-6);
    EXPECT_NEAR(found.seen, 1.8 * 1.8, 1e-6);
    EXPECT_NEAR(found.surface, 1.8 * 1.8 + (has_lower_side ? 2 : 1), 1e-6);
    EXPECT_NEAR(found.above, 0.4, 1e-6);  // of 1 x 1 x 0.4
    EXPECT_NEAR(found.below, 0, 1e-6);
    EXPECT_NEAR(found.plane.level, 0.4 / (1.8 * 1.8), 1e-6);
    EXPECT_NEAR(found.highest - found.lowest, 0.4, 1e-6);
  }
}

// A square through the ground, with the slope 0.8: the ground hides the half that is lower. The
// order of the faces does not matter.
TEST(AreaMeasures, SurfacesThatCutEachOtherAreSeenAboveTheirLine) {
  for (const bool square_first : {true, false}) {
    Mesh mesh;
    if (square_first) add_square(mesh, 0, true, 0.8f);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    const Mesh level = graph(7, [](double, double) { return 0.0; });
    mesh.vertices.insert(mesh.vertices.end(), level.vertices.begin(), level.vertices.end());
    for (const auto& [a, b, c] : level.faces)
      mesh.faces.push_back({first + a, first + b, first + c});
    if (!square_first) add_square(mesh, 0, true, 0.8f);
    const AreaMeasures found = AreaMeter(mesh, Eigen::Vector3d::Zero()).measure(kWide);
    const double steep = std::sqrt(1 + 0.8 * 0.8);
    EXPECT_NEAR(found.planar, 1.8 * 1.8, 1e-6);
    EXPECT_NEAR(found.seen, 1.8 * 1.8 - 0.5 + 0.5 * steep, 1e-6);
    EXPECT_NEAR(found.surface, 1.8 * 1.8 + steep, 1e-6);
    EXPECT_NEAR(found.above, 0.5 * 0.5 * 0.4, 1e-6);  // of a wedge
    EXPECT_NEAR(found.lowest, 0, 1e-6);
  }
}

// The same surface twice counts once, and so do three layers of a slope, as of a mesh that fits
// badly.
TEST(AreaMeasures, LayersCountOnce) {
  const auto slope = [](double x, double y) { return 0.5 * x + 0.25 * y; };
  Mesh mesh = graph(13, slope);
  for (const double lower : {0.0, 0.01}) {
    const Mesh layer =
        graph(lower > 0 ? 10 : 13, [&](double x, double y) { return slope(x, y) - lower; });
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), layer.vertices.begin(), layer.vertices.end());
    for (const auto& [a, b, c] : layer.faces)
      mesh.faces.push_back({first + a, first + b, first + c});
  }
  const AreaMeasures found = AreaMeter(mesh, Eigen::Vector3d::Zero()).measure(disc({0.1, 0}, 0.7));
  const double steep = std::sqrt(1 + 0.25 + 0.0625);
  EXPECT_NEAR(found.planar, found.polygon, 1e-6);
  EXPECT_NEAR(found.rugosity(), steep, 1e-6);
  EXPECT_NEAR(found.whole_rugosity(), 3 * steep, 1e-5);
  EXPECT_NEAR(found.above, 0, 1e-6);
  EXPECT_NEAR(found.below, 0, 1e-6);
}

// A whole sphere on the ground: its upper half is seen, which hangs over a disc of the ground.
TEST(AreaMeasures, OfASphereTheUpperHalfIsSeen) {
  constexpr int kRings = 16, kSides = 32;
  const double radius = 0.4, height = 0.4;
  Mesh mesh = graph(4, [](double, double) { return 0.0; });
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int j = 0; j <= kRings; ++j)
    for (int i = 0; i < kSides; ++i) {
      const double polar = kPi * j / kRings, around = 2 * kPi * i / kSides;
      mesh.vertices.emplace_back(Eigen::Vector3d(radius * std::sin(polar) * std::cos(around),
                                                 radius * std::sin(polar) * std::sin(around),
                                                 height + radius * std::cos(polar))
                                     .cast<float>());
    }
  const auto at = [&](int j, int i) {
    return first + static_cast<std::uint32_t>(j * kSides + i % kSides);
  };
  for (int j = 0; j < kRings; ++j)
    for (int i = 0; i < kSides; ++i) {
      mesh.faces.push_back({at(j, i), at(j + 1, i), at(j + 1, i + 1)});
      mesh.faces.push_back({at(j, i), at(j + 1, i + 1), at(j, i + 1)});
    }
  const AreaMeasures found = AreaMeter(mesh, Eigen::Vector3d::Zero()).measure(kWide);
  // A circle of 32 corners is too small by 0.64 %, and a sphere of such circles by twice that.
  const double shadow = kPi * radius * radius;
  EXPECT_NEAR(found.planar, 1.8 * 1.8, 1e-6);
  EXPECT_NEAR(found.seen, 1.8 * 1.8 + shadow, 0.015 * 2 * shadow);
  EXPECT_NEAR(found.surface, 1.8 * 1.8 + 4 * shadow, 0.015 * 4 * shadow);
  const double volume = shadow * height + 2 * kPi / 3 * std::pow(radius, 3);
  EXPECT_NEAR(found.above, volume, 0.015 * volume);
  EXPECT_NEAR(found.highest, height + radius, 1e-6);
}

TEST(AreaMeasures, OfHolesAndOutsideAreTold) {
  const Mesh mesh = graph(10, [](double, double) { return 0.0; });
  const AreaMeter meter(mesh, Eigen::Vector3d::Zero());
  const AreaMeasures half = meter.measure({"half", {{{{0, -0.5}, {2, -0.5}, {2, 0.5}, {0, 0.5}}}}});
  EXPECT_NEAR(half.planar, 1, 1e-6);
  EXPECT_NEAR(half.polygon, 2, 1e-9);
  EXPECT_NEAR(half.rim, 0.5, 2e-3);  // 2000 places; a half of 6 m
  const AreaMeasures outside = meter.measure(disc({5, 5}, 1));
  EXPECT_EQ(outside.planar, 0);
  EXPECT_EQ(outside.surface, 0);
  for (const double value : {outside.lowest, outside.highest, outside.above, outside.below,
                             outside.rugosity(), outside.roughness(), outside.slope_degrees(),
                             outside.aspect_degrees(), half.aspect_degrees()})
    EXPECT_TRUE(std::isnan(value));
  const AreaMeasures little =
      meter.measure({"corner", {{{{0.9, 0.9}, {3, 0.9}, {3, 3}, {0.9, 3}}}}});
  EXPECT_NEAR(little.planar, 0.01, 1e-6);
  EXPECT_TRUE(std::isnan(little.above));  // a tenth of the rim has a surface
}

// Two mounds on a step: each part has the plane of its own rim.
TEST(AreaMeasures, PartsHaveRimsOfTheirOwn) {
  const auto mound = [](double x, double y) {
    return std::max(0.0, 0.1 * (1 - (x * x + y * y) / 0.04));
  };
  const Mesh mesh = graph(400, [&](double x, double y) {
    return (x > 0 ? 3 : 0) + mound(x + 0.5, y) + mound(x - 0.5, y);
  });
  Area both = disc({-0.5, 0}, 0.3);
  both.parts.push_back(disc({0.5, 0}, 0.3).parts[0]);
  const AreaMeasures found = AreaMeter(mesh, Eigen::Vector3d::Zero()).measure(both);
  EXPECT_NEAR(found.above, 2 * kPi / 2 * 0.1 * 0.04, 2e-5);  // of two paraboloids
  EXPECT_NEAR(found.planar, found.polygon, 1e-6);
}

// A closed box alone: its upper side is seen.
TEST(AreaMeasures, OfAClosedBodyAloneAreThoseOfItsUpperSide) {
  Mesh mesh = graph(3, [](double, double) { return 1.0; });
  Mesh lower = graph(3, [](double, double) { return 0.0; });
  for (const auto& [a, b, c] : lower.faces) {
    const auto first = static_cast<std::uint32_t>(16);
    mesh.faces.push_back({a + first, c + first, b + first});
  }
  mesh.vertices.insert(mesh.vertices.end(), lower.vertices.begin(), lower.vertices.end());
  const AreaMeasures found =
      AreaMeter(mesh, Eigen::Vector3d::Zero()).measure(disc({0.1, 0.1}, 0.5));
  EXPECT_NEAR(found.planar, found.polygon, 1e-6);
  EXPECT_NEAR(found.surface, 2 * found.polygon, 1e-6);
  EXPECT_NEAR(found.lowest, 1, 1e-6);
}

// Two large faces close a body below 20,000 small ones. This does not end if lines between small
// faces count as parts of a large face.
TEST(AreaMeasures, LargeFacesBelowSmallOnesAreHidden) {
  const auto relief = [](double x, double y) { return 0.1 * std::sin(5 * x) * std::cos(4 * y); };
  Mesh mesh = graph(100, relief);
  const Mesh lower = graph(1, [](double, double) { return -2.0; });
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const auto& [a, b, c] : lower.faces) mesh.faces.push_back({a + first, c + first, b + first});
  mesh.vertices.insert(mesh.vertices.end(), lower.vertices.begin(), lower.vertices.end());
  const AreaMeasures closed = AreaMeter(mesh, Eigen::Vector3d::Zero()).measure(kWide);
  const AreaMeasures open = AreaMeter(graph(100, relief), Eigen::Vector3d::Zero()).measure(kWide);
  EXPECT_NEAR(closed.seen, open.seen, 1e-5);  // lines of 1e-7 m beside 100 rows of faces
  EXPECT_NEAR(closed.planar, open.planar, 1e-5);
  EXPECT_EQ(closed.lowest, open.lowest);
  EXPECT_NEAR(closed.surface, open.surface + 1.8 * 1.8, 1e-5);
  // A band along the diagonals of the faces: most faces beside it have no edge that separates them.
  const Area band{"band", {{{{-0.9, -0.9}, {0.9, 0.85}, {0.9, 0.9}}}}};
  EXPECT_NEAR(AreaMeter(mesh, Eigen::Vector3d::Zero()).measure(band).planar, 1.8 * 0.05 / 2, 1e-5);
}

}  // namespace
}  // namespace axial::map
