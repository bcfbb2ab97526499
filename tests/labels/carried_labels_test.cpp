// SPDX-License-Identifier: GPL-3.0-or-later
// A camera behind a tilted flat port looks down on a level ground and on a plate above it. The map
// has UTM coordinates.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "labels/fill.h"
#include "labels/map_to_photographs.h"
#include "labels/photographs_to_map.h"

namespace axial::labels {
namespace {

constexpr double kGround = 1, kPlate = 0.6;                 // z [m], downwards
constexpr double kLeft = 0.02, kRight = 0.2, kHalf = 0.15;  // x and y of the plate [m]
const Eigen::Vector3d kOffset(512345, 2512345, -8);         // of the map
constexpr double kPixel = 1 / 300.0;                        // width on the ground [m]

geometry::PosedCamera camera() {
  geometry::PosedCamera posed;
  posed.camera.width = 320;
  posed.camera.height = 240;
  posed.camera.lens.fx = posed.camera.lens.fy = 220;
  posed.camera.lens.cx = 157.5;
  posed.camera.lens.cy = 121;
  posed.camera.port = refractive::FlatPort<double>{
      Eigen::Vector3d(0.05, -0.03, 1).normalized(), 0.03, 0.012, 1, 1.49, 1.34};
  return posed;
}

void add_rectangle(Mesh& mesh, double left, double right, double half, double z) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const auto& [x, y] : {std::pair(left, -half), std::pair(left, half), std::pair(right, half),
                             std::pair(right, -half)})
    mesh.vertices.push_back(Eigen::Vector3d(x, y, z).cast<float>());
  mesh.faces.push_back({first, first + 1, first + 2});
  mesh.faces.push_back({first, first + 2, first + 3});
}

Mesh ground() {
  Mesh mesh;
  add_rectangle(mesh, -3, 3, 3, kGround);
  return mesh;
}

Mesh ground_and_plate() {
  Mesh mesh = ground();
  add_rectangle(mesh, kLeft, kRight, kHalf, kPlate);
  return mesh;
}

// x of the map is that of the world, y and heights are the opposite of the world's.
map::WorldAxes axes() {
  map::WorldAxes axes;
  axes.axes = Eigen::Vector3d(1, -1, -1).asDiagonal();
  axes.offset = kOffset;
  return axes;
}

Eigen::Vector2d on_map(double x, double y) {
  return {x + kOffset.x(), -y + kOffset.y()};
}

// A rectangle of the world.
map::Label rectangle(double left, double right, double low, double high) {
  map::Label label{"plot", "coral", {}, {}};
  label.parts = {
      {{on_map(left, low), on_map(left, high), on_map(right, high), on_map(right, low)}}};
  return label;
}

double distance_to(const geometry::Ring& ring, const Eigen::Vector2d& place) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d a = ring[i], way = ring[(i + 1) % ring.size()] - a;
    const double at = std::clamp((place - a).dot(way) / way.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (a + at * way - place).norm());
  }
  return least;
}

// Places along a ring.
geometry::Ring along(const geometry::Ring& ring) {
  constexpr int kSteps = 50;
  geometry::Ring places;
  for (std::size_t i = 0; i < ring.size(); ++i)
    for (int k = 0; k < kSteps; ++k)
      places.push_back(ring[i] + k / double{kSteps} * (ring[(i + 1) % ring.size()] - ring[i]));
  return places;
}

// The exact image of a ring on the ground.
geometry::Ring image_of(const geometry::Ring& ring) {
  const PosedRays rays(camera());
  geometry::Ring image;
  for (const Eigen::Vector2d& place : along(ring))
    image.push_back(*rays.pixel_of({place.x() - kOffset.x(), -(place.y() - kOffset.y()), kGround}));
  return image;
}

TEST(MapLabels, LieWhereTheCameraSeesThem) {
  const Mesh mesh = ground();
  const LabelledSurface surface(mesh, {}, axes());
  map::Label label = rectangle(-0.3, 0.2, -0.1, 0.25);
  label.parts[0].push_back({on_map(-0.1, 0), on_map(0, 0), on_map(0, 0.1), on_map(-0.1, 0.1)});
  const std::vector<map::Label> labels{rectangle(2, 2.5, 0, 1), label};
  const auto seen = MapLabels(surface, labels).seen_in(PosedRays(camera()));
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_EQ(seen[0].index, 1U);
  EXPECT_EQ(seen[0].label.category, "coral");
  ASSERT_EQ(seen[0].label.parts.size(), 1U);
  ASSERT_EQ(seen[0].label.parts[0].size(), 2U);
  for (std::size_t ring = 0; ring < 2; ++ring) {
    const geometry::Ring &found = seen[0].label.parts[0][ring],
                         image = image_of(label.parts[0][ring]);
    // Places that are found up to 1/128, and straight lines that leave out a fiftieth.
    for (const Eigen::Vector2d& place : along(found)) EXPECT_LT(distance_to(image, place), 0.55);
    for (const Eigen::Vector2d& corner : found) EXPECT_LT(distance_to(image, corner), 0.02);
    double sum = 0;
    for (const Eigen::Vector2d& place : image) {
      EXPECT_LT(distance_to(found, place), 0.4);  // a right angle is cut by up to 0.36 px
      sum += distance_to(found, place);
    }
    EXPECT_LT(sum / static_cast<double>(image.size()), 0.06);
  }
}

// Each pixel by its ray and the planes, without the mesh.
TEST(MapLabels, AreCutWhereThePlateHidesThemAndAtTheBorder) {
  const Mesh mesh = ground_and_plate();
  const LabelledSurface surface(mesh, {}, axes());
  const std::vector<map::Label> labels{rectangle(0.22, 2, -0.05, 0.1)};
  const geometry::PosedCamera posed = camera();
  const auto seen = MapLabels(surface, labels).seen_in(PosedRays(posed));
  ASSERT_EQ(seen.size(), 1U);
  cv::Mat1w mask(240, 320, std::uint16_t{0});
  fill(seen[0].label.parts, 7, mask);
  const PosedRays rays(posed);
  int inside = 0, hidden = 0, different = 0;
  for (int y = 0; y < 240; ++y)
    for (int x = 0; x < 320; ++x) {
      const Sight sight = *rays.sight({x, y});
      const auto at = [&](double z) {
        return Eigen::Vector3d(sight.from +
                               (z - sight.from.z()) / sight.direction.z() * sight.direction);
      };
      const auto is_labelled = [](const Eigen::Vector3d& place) {
        return place.x() > 0.22 && place.x() < 2 && place.y() > -0.05 && place.y() < 0.1;
      };
      const Eigen::Vector3d high = at(kPlate);
      const bool is_plate = high.x() > kLeft && high.x() < kRight && std::abs(high.y()) < kHalf;
      const bool expected = is_labelled(is_plate ? high : at(kGround));
      inside += expected;
      hidden += is_plate && !expected && is_labelled(at(kGround));
      different += expected != (mask(y, x) == 7);
    }
  EXPECT_GT(inside, 2000);
  EXPECT_GT(hidden, 800);
  EXPECT_LE(different, 10);  // on the outline, which leaves out some hundredths of a pixel
  double right = 0;
  for (const auto& part : seen[0].label.parts)
    for (const Eigen::Vector2d& corner : part[0]) right = std::max(right, corner.x());
  EXPECT_NEAR(right, 319.5, 0.02);  // the outer border of the last pixel
}

TEST(MapLabels, PointsAreSeenUnlessHiddenOrOutside) {
  const Mesh mesh = ground_and_plate();
  const LabelledSurface surface(mesh, {}, axes());
  std::vector<map::Label> labels(1);
  // On the ground; on the plate; behind the plate as seen by the camera; outside.
  labels[0].points = {on_map(-0.2, 0.1), on_map(0.1, 0), on_map(0.25, 0), on_map(3, 0)};
  const PosedRays rays(camera());
  const auto seen = MapLabels(surface, labels).seen_in(rays);
  ASSERT_EQ(seen.size(), 1U);
  ASSERT_EQ(seen[0].label.points.size(), 2U);
  EXPECT_LT((seen[0].label.points[0] - *rays.pixel_of({-0.2, 0.1, kGround})).norm(), 1e-3);
  EXPECT_LT((seen[0].label.points[1] - *rays.pixel_of({0.1, 0, kPlate})).norm(), 1e-3);
}

TEST(CarriedLabels, ComeBackToTheMap) {
  const Mesh mesh = ground();
  const LabelledSurface surface(mesh, {}, axes());
  map::Label label = rectangle(-0.3, 0.2, -0.1, 0.25);
  label.points = {on_map(0.05, -0.2)};
  const PosedRays rays(camera());
  const auto seen = MapLabels(surface, std::vector{label}).seen_in(rays);
  ASSERT_EQ(seen.size(), 1U);
  const CarriedLabel back = carried_to_map(surface, rays, seen[0].label, 0.02);
  EXPECT_EQ(back.label.name, "plot");
  EXPECT_EQ(back.missing, 0);
  ASSERT_EQ(back.label.parts.size(), 1U);
  ASSERT_EQ(back.label.parts[0].size(), 1U);
  const geometry::Ring &first = label.parts[0][0], &again = back.label.parts[0][0];
  // Both outlines cut right angles by up to 0.36 px.
  for (const Eigen::Vector2d& place : along(again))
    EXPECT_LT(distance_to(first, place), 1.1 * kPixel);
  for (const Eigen::Vector2d& place : along(first))
    EXPECT_LT(distance_to(again, place), 1.5 * kPixel);
  ASSERT_EQ(back.label.points.size(), 1U);
  EXPECT_LT((back.label.points[0] - label.points[0]).norm(), 1e-5);
  ASSERT_EQ(back.heights.size(), again.size() + 1);
  for (const double height : back.heights) EXPECT_NEAR(height, kOffset.z() - kGround, 1e-5);
}

// A line around the plate that is drawn a bit too far outside of three edges. The left edge is
// nearly below the camera: ground that is seen beside it would touch the plate on the map.
TEST(CarriedLabels, DoNotTearAtAnEdge) {
  const Mesh mesh = ground_and_plate();
  const LabelledSurface surface(mesh, {}, axes());
  const PosedRays rays(camera());
  map::Label drawn{"plate", "plate", {{{}}}, {}};
  constexpr double kOver = 0.007;
  for (const auto& [x, y] :
       {std::pair(kLeft, -kHalf - kOver), std::pair(kLeft, kHalf + kOver),
        std::pair(kRight + kOver, kHalf + kOver), std::pair(kRight + kOver, -kHalf - kOver)})
    drawn.parts[0][0].push_back(*rays.pixel_of({x, y, kPlate}));
  EXPECT_GT(carried_to_map(surface, rays, drawn, 0).label.parts.size(), 1U);
  const CarriedLabel carried = carried_to_map(surface, rays, drawn, 0.3);
  ASSERT_EQ(carried.label.parts.size(), 1U);
  const geometry::Ring plate = rectangle(kLeft, kRight, -kHalf, kHalf).parts[0][0];
  for (const Eigen::Vector2d& place : along(plate))
    EXPECT_LT(distance_to(carried.label.parts[0][0], place), kPixel);
  for (const double height : carried.heights) EXPECT_NEAR(height, kOffset.z() - kPlate, 1e-5);
}

// Looks along x, 65 degrees from the vertical.
geometry::PosedCamera oblique_camera() {
  constexpr double kTilt = 65 * std::numbers::pi / 180;
  geometry::PosedCamera posed = camera();
  posed.pose.rotation.row(0) << std::cos(kTilt), 0, -std::sin(kTilt);
  posed.pose.rotation.row(1) << 0, 1, 0;
  posed.pose.rotation.row(2) << std::sin(kTilt), 0, std::cos(kTilt);
  return posed;
}

// The ground behind the plate is larger on the map than the plate, but not in the photograph.
TEST(CarriedLabels, ThatAreObliqueKeepThePartOfMostPixels) {
  constexpr double kNear = 1.2, kFar = 1.4, kOver = 0.12;
  const PosedRays rays(oblique_camera());
  Mesh mesh = ground();
  add_rectangle(mesh, kNear, kFar, kHalf, kPlate);
  const LabelledSurface surface(mesh, {}, axes());
  map::Label drawn{"plate", "plate", {{{}}}, {}};
  for (const auto& [x, y] : {std::pair(kNear, -kHalf), std::pair(kNear, kHalf),
                             std::pair(kFar + kOver, kHalf), std::pair(kFar + kOver, -kHalf)})
    drawn.parts[0][0].push_back(*rays.pixel_of({x, y, kPlate}));
  const auto is_plate = [](const auto& part) {
    return std::ranges::all_of(part[0], [](const Eigen::Vector2d& corner) {
      return corner.x() - kOffset.x() < kFar + kPixel;
    });
  };
  double plate = 0, behind = 0;
  for (const auto& part : carried_to_map(surface, rays, drawn, 0).label.parts)
    (is_plate(part) ? plate : behind) += geometry::PolygonPieces(part).area();
  EXPECT_GT(behind, 1.2 * plate);
  const CarriedLabel carried = carried_to_map(surface, rays, drawn, 0.5);
  ASSERT_EQ(carried.label.parts.size(), 1U);
  EXPECT_TRUE(is_plate(carried.label.parts[0]));
  EXPECT_LT(carried.coarseness, 1.001);
}

// Most of the label is near, and its tip is next to the horizon.
TEST(CarriedLabels, WithAFarPlaceAreCoarse) {
  Mesh mesh;
  add_rectangle(mesh, -300, 300, 300, kGround);
  const LabelledSurface surface(mesh, {}, axes());
  const PosedRays rays(oblique_camera());
  map::Label drawn{"a", "a", {{{}}}, {}};
  for (const auto& [x, y] : {std::pair(1.0, -0.2), std::pair(1.0, 0.2), std::pair(100.0, 0.0)})
    drawn.parts[0][0].push_back(*rays.pixel_of({x, y, kGround}));
  ASSERT_TRUE(rays.is_in_photograph(drawn.parts[0][0][2]));
  EXPECT_GT(carried_to_map(surface, rays, drawn, 0).coarseness, 2);
}

TEST(CarriedLabels, BesideTheSurfaceAreEmpty) {
  Mesh mesh;
  add_rectangle(mesh, -0.3, -0.1, 0.3, kGround);
  const LabelledSurface surface(mesh, {}, axes());
  const PosedRays rays(camera());
  map::Label drawn{"a", "a", {{{{200, 20}, {300, 20}, {300, 200}}}}, {{250.0, 100.0}}};
  const CarriedLabel carried = carried_to_map(surface, rays, drawn, 0);
  EXPECT_TRUE(carried.label.parts.empty());
  EXPECT_TRUE(carried.label.points.empty());
  EXPECT_EQ(carried.missing, 1);
}

}  // namespace
}  // namespace axial::labels
