// SPDX-License-Identifier: GPL-3.0-or-later
// Squares on a slope, as of several photographs that each see a part of an object.
#include "labels/joined_labels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "geometry/polygon_pieces.h"
#include "map/united_parts.h"

namespace axial::labels {
namespace {

const Eigen::Vector3d kMapOffset(500000, 4000000, -12);

// The slope z = x / 2.
Mesh slope() {
  Mesh mesh;
  mesh.vertices = {{-2, -2, -1}, {2, -2, 1}, {2, 2, 1}, {-2, 2, -1}};
  mesh.faces = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

map::WorldAxes shifted() {
  map::WorldAxes axes;
  axes.offset = kMapOffset;
  return axes;
}

map::LabelFromPhotograph box(const std::string& photograph, const std::string& name,
                             const std::string& category, double left, double right) {
  map::LabelFromPhotograph one{photograph, {name, category, {}, {}}, {}};
  geometry::Ring ring;
  for (const auto& [x, y] :
       {std::pair(left, 0.0), std::pair(right, 0.0), std::pair(right, 1.0), std::pair(left, 1.0)})
    ring.push_back(kMapOffset.head<2>() + Eigen::Vector2d(x, y));
  one.label.parts = {{ring}};
  one.heights.assign(4, 0.0);
  return one;
}

double area_of(const map::PolygonParts& parts) {
  double area = 0;
  for (const auto& part : parts) area += geometry::PolygonPieces(part).area();
  return area;
}

std::vector<map::LabelFromPhotograph> joined(std::vector<map::LabelFromPhotograph> labels,
                                             const JoinOptions& options) {
  const Mesh mesh = slope();
  return joined_labels(LabelledSurface(mesh, {}, shifted()), std::move(labels), options);
}

TEST(JoinedLabels, OfOneNameAreUnited) {
  const auto found = joined({box("a", "c1", "coral", 0, 0.6), box("b", "c2", "coral", 0, 0.6),
                             box("b", "c1", "coral", 0.4, 1), box("c", "c1", "alga", 0, 1),
                             box("c", "coral", "coral", 0, 1), box("d", "coral", "coral", 0, 1),
                             box("d", "c1", "coral", -1, -0.5)},
                            {Join::name, 0.5});
  ASSERT_EQ(found.size(), 5U);  // a label with the name of its class stays alone
  EXPECT_EQ(found[0].label.name, "c1");
  EXPECT_EQ(found[0].photograph, "a; b; d");
  ASSERT_EQ(found[0].label.parts.size(), 2U);
  EXPECT_NEAR(area_of(found[0].label.parts), 1.5, 1e-6);
  std::size_t corner = 0;  // heights are those of the slope
  for (const auto& part : found[0].label.parts)
    for (const geometry::Ring& ring : part)
      for (const Eigen::Vector2d& place : ring)
        EXPECT_NEAR(found[0].heights.at(corner++),
                    kMapOffset.z() + (place.x() - kMapOffset.x()) / 2, 1e-5);
  EXPECT_EQ(corner, found[0].heights.size());
}

TEST(JoinedLabels, ThatOverlapAreUnited) {
  // The first and the third have nothing in common, but the second has 60 % of both.
  const std::vector<map::LabelFromPhotograph> labels{
      box("a", "coral", "coral", 0, 0.5), box("c", "coral", "coral", 0.6, 1.1),
      box("b", "coral", "coral", 0.2, 0.9), box("b", "alga", "alga", 0, 1),
      box("c", "coral", "coral", 1.0, 1.9)};
  const auto found = joined(labels, {Join::overlap, 0.5});
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].photograph, "a; c; b");
  EXPECT_NEAR(area_of(found[0].label.parts), 1.1, 1e-6);
  EXPECT_NEAR(area_of(found[2].label.parts), 0.9, 1e-6);  // a fifth of the smaller one in common
  EXPECT_EQ(joined(labels, {Join::overlap, 0.65}).size(), 5U);
  EXPECT_EQ(joined(labels, {}).size(), 5U);
}

TEST(UnitedParts, ShareOfTheSmallerPolygon) {
  const auto a = box("", "", "", 0, 1).label.parts, b = box("", "", "", 0.75, 1.25).label.parts;
  EXPECT_NEAR(map::common_share(a, b), 0.5, 1e-9);
  EXPECT_NEAR(map::common_share(b, a), 0.5, 1e-9);
  EXPECT_EQ(map::common_share(a, box("", "", "", 2, 3).label.parts), 0);
}

// A hole that one polygon has is filled by another one in part.
TEST(UnitedParts, KeepHolesThatNoPolygonFills) {
  map::PolygonParts ring = box("", "", "", 0, 1).label.parts;
  geometry::Ring hole;
  for (const auto& [x, y] :
       {std::pair(0.25, 0.25), std::pair(0.75, 0.25), std::pair(0.75, 0.75), std::pair(0.25, 0.75)})
    hole.push_back(kMapOffset.head<2>() + Eigen::Vector2d(x, y));
  ring[0].push_back(hole);
  const map::PolygonParts half = box("", "", "", 0, 0.5).label.parts;
  const map::PolygonParts* const both[] = {&ring, &half};
  const map::PolygonParts found = map::united(both);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].size(), 2U);
  EXPECT_NEAR(area_of(found), 1 - 0.25 * 0.5, 1e-6);
}

}  // namespace
}  // namespace axial::labels
