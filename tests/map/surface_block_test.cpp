// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/surface_block.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "drawn.h"
#include "worlds/height_field.h"

namespace axial::map {
namespace {

constexpr double kExactPixel = 0.03125;  // a power of two: no rounding in the tests

SurfaceBlock whole_map(const Mesh& mesh, const MapFrame& frame, const MapGrid& grid,
                       int samples = 1) {
  const FaceBins bins(mesh, frame, grid, std::max(grid.columns, grid.rows));
  return look_from_above(mesh, frame, grid, bins.pixels(0), samples, bins.faces(0));
}

// A plane and a ridge along the diagonals of the cells are linear in each face, so that the mesh is
// exactly the function. Half a pixel of displacement is an error of more than 1 cm.
TEST(SurfaceBlock, HeightsAreThoseOfTheFunctionAtPixelCentres) {
  const auto height = [](double x, double y) { return 0.7 * x - 0.4 * y + 2 * std::abs(x - y); };
  const Mesh mesh = test::height_field({-1, -0.5}, {1, 1.5}, 16, height);
  for (const Eigen::Vector3d& origin : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(5e5, 4.5e6, 0)}) {
    const MapFrame frame = frame_with_up({0, 0, 1}, {origin});
    const MapGrid grid = grid_around(mesh, frame, kExactPixel);
    ASSERT_EQ(grid.columns, 64);
    ASSERT_EQ(grid.rows, 64);
    const SurfaceBlock block = whole_map(mesh, frame, grid);
    for (int row = 0; row < grid.rows; ++row)
      for (int column = 0; column < grid.columns; ++column) {
        const double x = grid.left + (column + 0.5) * kExactPixel - origin.x();
        const double y = grid.top - (row + 0.5) * kExactPixel - origin.y();
        EXPECT_NEAR(block.heights(row, column), height(x, y), 1e-6) << column << " " << row;
      }
  }
}

TEST(SurfaceBlock, TheMiddleOfOddSamplesIsThePixelCentre) {
  const Mesh mesh = test::height_field(
      {0, 0}, {1, 1}, 7, [](double x, double y) { return std::sin(5 * x) * std::cos(4 * y); });
  const MapFrame frame = frame_with_up({0, 0, 1}, {});
  const MapGrid grid = grid_around(mesh, frame, kExactPixel);
  const SurfaceBlock centres = whole_map(mesh, frame, grid), fine = whole_map(mesh, frame, grid, 5);
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      EXPECT_NEAR(fine.heights(5 * row + 2, 5 * column + 2), centres.heights(row, column), 1e-6);
      EXPECT_LT((fine.place(5 * row + 2, 5 * column + 2) - centres.place(row, column)).norm(),
                1e-12);
    }
}

// A table over a floor: the floor below the table is not visible, and the table is not seen twice.
TEST(SurfaceBlock, TheHighestSurfaceIsVisible) {
  Mesh mesh = test::height_field({-1, -1}, {1, 1}, 4, [](double, double) { return 0.0; });
  const std::size_t floor_faces = mesh.faces.size();
  const Mesh table =
      test::height_field({-0.5, -0.25}, {0.5, 0.25}, 2, [](double, double) { return 0.3; });
  test::append(mesh, table);
  const MapFrame frame = frame_with_up({0, 0, 1}, {});
  const MapGrid grid = grid_around(mesh, frame, kExactPixel);
  const SurfaceBlock block = whole_map(mesh, frame, grid);
  int on_table = 0;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const bool is_table = block.face(row, column) >= floor_faces;
      EXPECT_EQ(block.heights(row, column), is_table ? 0.3f : 0.0f);
      on_table += is_table;
    }
  EXPECT_EQ(on_table, 32 * 16);
}

// Faces with their back to the viewer are seen, too: the mesh turned over has the same heights.
TEST(SurfaceBlock, TheOrderOfTheCornersHasNoEffect) {
  Mesh mesh = test::height_field({0, 0}, {1, 1}, 9, [](double x, double y) { return x * y; });
  const MapFrame frame = frame_with_up({0, 0, 1}, {});
  const MapGrid grid = grid_around(mesh, frame, kExactPixel);
  const SurfaceBlock before = whole_map(mesh, frame, grid);
  for (auto& face : mesh.faces) std::swap(face[0], face[2]);
  const SurfaceBlock after = whole_map(mesh, frame, grid);
  EXPECT_LT(cv::norm(before.heights, after.heights, cv::NORM_INF), 1e-6);
}

TEST(SurfaceBlock, HolesHaveNoHeight) {
  Mesh mesh = test::height_field({0, 0}, {1, 1}, 4, [](double, double) { return 1.0; });
  mesh.faces.erase(mesh.faces.begin() + 10, mesh.faces.begin() + 12);  // the second cell of row 1
  const MapFrame frame = frame_with_up({0, 0, 1}, {});
  const MapGrid grid = grid_around(mesh, frame, kExactPixel);
  const SurfaceBlock block = whole_map(mesh, frame, grid);
  for (int row = 0; row < 32; ++row)
    for (int column = 0; column < 32; ++column) {
      const bool in_hole = column >= 8 && column < 16 && row >= 16 && row < 24;
      EXPECT_EQ(std::isnan(block.heights(row, column)), in_hole);
      EXPECT_EQ(block.face(row, column) == kNoFace, in_hole);
    }
}

// Vertices at arbitrary places, and a grid that does not fit them: no sample falls between faces.
TEST(SurfaceBlock, NoGapsBetweenFaces) {
  Mesh mesh = test::height_field({0, 0}, {1, 1}, 40, [](double, double) { return 0.0; });
  std::mt19937 random(3);
  std::uniform_real_distribution<float> shift(-0.01f, 0.01f);
  for (Eigen::Vector3f& vertex : mesh.vertices)
    if (vertex.x() > 0 && vertex.x() < 1 && vertex.y() > 0 && vertex.y() < 1)
      vertex.head<2>() += axial::test::drawn<2>(shift, random);
  const MapFrame frame = frame_with_up({0.1, -0.2, 1}, {});
  const MapGrid grid = grid_around(mesh, frame, 1.0 / 333);
  const SurfaceBlock block = whole_map(mesh, frame, grid, 3);
  // Rows that cross the sheet are filled from the first to the last sample.
  int filled = 0;
  for (int row = 0; row < block.faces.rows; ++row) {
    int first = -1, last = -1, count = 0;
    for (int column = 0; column < block.faces.cols; ++column)
      if (block.face(row, column) != kNoFace) {
        first = first < 0 ? column : first, last = column;
        ++count;
      }
    EXPECT_EQ(count, first < 0 ? 0 : last - first + 1) << row;
    filled += count;
  }
  EXPECT_GT(filled, 700'000);
}

TEST(SurfaceBlock, BlocksHaveNoEffect) {
  const Mesh mesh = test::height_field({-0.77, 0.33}, {0.97, 1.91}, 13, [](double x, double y) {
    return std::sin(9 * x) + std::cos(7 * y);
  });
  const MapFrame frame = frame_with_up({0.3, 0.1, 1}, {{3e5, 2e6, 0}});
  const MapGrid grid = grid_around(mesh, frame, 0.0123);
  const SurfaceBlock whole = whole_map(mesh, frame, grid, 3);
  const FaceBins bins(mesh, frame, grid, 32);
  int pixels = 0;
  for (std::size_t b = 0; b < bins.blocks(); ++b) {
    const cv::Rect at = bins.pixels(b);
    const SurfaceBlock block = look_from_above(mesh, frame, grid, at, 3, bins.faces(b));
    const cv::Rect samples(3 * at.x, 3 * at.y, 3 * at.width, 3 * at.height);
    EXPECT_EQ(cv::countNonZero(block.faces != whole.faces(samples)), 0);
    cv::Mat1f a = block.heights.clone(), c = whole.heights(samples).clone();
    cv::patchNaNs(a, -1e9), cv::patchNaNs(c, -1e9);
    EXPECT_EQ(cv::countNonZero(a != c), 0);
    pixels += at.area();
  }
  EXPECT_EQ(pixels, grid.pixels());
  EXPECT_GE(FaceBins::bytes(mesh, frame, grid, 32), 4 * mesh.faces.size());
}

TEST(SurfaceBlock, WeightsGiveTheHeightAndThePlace) {
  const Mesh mesh = test::height_field(
      {0, 0}, {1, 1}, 5, [](double x, double y) { return std::sin(5 * x) * std::cos(4 * y); });
  const MapFrame frame = frame_with_up({0, 0, 1}, {});
  const MapGrid grid = grid_around(mesh, frame, 0.013);
  const SurfaceBlock block = whole_map(mesh, frame, grid);
  for (int row = 1; row < grid.rows - 1; ++row)
    for (int column = 1; column < grid.columns - 1; ++column) {
      const std::uint32_t face = block.face(row, column);
      ASSERT_NE(face, kNoFace);
      const FaceCorners corners = corners_of(mesh, face, frame, grid);
      const Eigen::Vector2d place = block.place(row, column);
      const Eigen::Vector3d weights = weights_at(corners, place);
      EXPECT_GE(weights.minCoeff(), 0);
      EXPECT_NEAR(weights.dot(corners.height), block.heights(row, column), 1e-6);
      EXPECT_LT((corners.at * weights - place).norm(), 1e-9);
    }
}

}  // namespace
}  // namespace axial::map
