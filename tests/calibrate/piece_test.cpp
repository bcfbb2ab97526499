// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces of checkerboards in drawn photographs.
#include "calibrate/piece.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "calibrate/board_survey.h"
#include "calibrate/photographs.h"
#include "calibrate/see_board.h"
#include "support/photograph.h"

namespace axial::calibrate {
namespace {

using testing::flat_port;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const io::ColmapCamera kLens{1, "PINHOLE", 640, 480, {380, 380, 320, 240}};
constexpr int kColumns = 8, kRows = 7;
const Board kPlain = parse_board("checkerboard:8x7:0.03");

// A photograph of kPlain, and where the exact projection puts its corners.
struct Drawn {
  cv::Mat1b photograph;
  std::vector<Eigen::Vector2d> corners;
};

// The middle of the board is at (x, y, z) [m] in the camera's frame.
Drawn drawn(double x, double y, double z, double turn_degrees = 10) {
  const auto corners = corners_of(kPlain);
  Pose pose;
  pose.rotation =
      Eigen::AngleAxisd(0.3, Eigen::Vector3d(0.5, 0.8, 0.1).normalized()).toRotationMatrix() *
      Eigen::AngleAxisd(turn_degrees * testing::kDegree, Eigen::Vector3d::UnitZ())
          .toRotationMatrix();
  pose.centre =
      (corners.front() + corners.back()) / 2 - pose.rotation.transpose() * Eigen::Vector3d(x, y, z);
  const CameraModel model = testing::camera_of(kLens, flat_port());
  Drawn result{
      test::photograph(model, pose, test::checkerboard(kPlain.columns, kPlain.rows, kPlain.size)),
      {}};
  const auto camera = make_camera<double>(model);
  for (const Eigen::Vector3d& corner : corners) {
    const auto image =
        std::visit([&](const auto& c) { return c.project(pose.to_camera(corner)); }, camera);
    result.corners.push_back(image.visible ? image.pixel : Eigen::Vector2d(-1e9, -1e9));
  }
  return result;
}

void add_noise(cv::Mat1b& photograph, double grey_levels) {
  cv::RNG random(1);
  cv::Mat1s noise(photograph.size());
  random.fill(noise, cv::RNG::NORMAL, 0, grey_levels);
  cv::add(photograph, noise, photograph, cv::noArray(), CV_8U);
}

// Puts a disc in front of the board, as the end of a thumb or a lamp's reflection.
void cover(cv::Mat1b& photograph, const Eigen::Vector2d& middle, double radius, double grey) {
  constexpr int kShift = 4;  // of cv::circle: sixteenths of a pixel
  const auto fixed = [](double value) { return static_cast<int>(std::lround(16 * value)); };
  cv::circle(photograph, {fixed(middle.x()), fixed(middle.y())}, fixed(radius), cv::Scalar(grey),
             cv::FILLED, cv::LINE_AA, kShift);
}

// The distance of each found corner from the nearest true one. Different found corners must be
// different true ones, in the same order of rows and columns but for the place on the board.
double largest_error(const std::vector<Corner>& corners, const Drawn& truth) {
  double largest = 0;
  std::vector<std::size_t> nearest;
  for (const Corner& corner : corners) {
    std::size_t best = 0;
    for (std::size_t i = 0; i < truth.corners.size(); ++i)
      if ((truth.corners[i] - corner.pixel).norm() < (truth.corners[best] - corner.pixel).norm())
        best = i;
    nearest.push_back(best);
    largest = std::max(largest, (truth.corners[best] - corner.pixel).norm());
  }
  // The piece may be turned by half a turn or by quarters of a turn: the distances of corners on
  // the board do not change.
  const auto place = [](std::size_t number) {
    return Eigen::Vector2d(static_cast<int>(number) % kColumns,
                           static_cast<int>(number) / kColumns);
  };
  for (std::size_t i = 1; i < nearest.size(); ++i)
    EXPECT_EQ((place(corners[i].number) - place(corners[0].number)).norm(),
              (place(nearest[i]) - place(nearest[0])).norm());
  return largest;
}

// Counts the corners that are at least `margin` [px] inside the photograph and away from a disc,
// and that belong to a square with four such corners.
int count_visible(const Drawn& truth, double margin, const Eigen::Vector2d& disc = {-1e9, 0},
                  double radius = 0) {
  cv::Mat1b visible(kRows, kColumns), counted(kRows, kColumns, std::uint8_t{0});
  for (std::size_t i = 0; i < truth.corners.size(); ++i) {
    const Eigen::Vector2d& at = truth.corners[i];
    visible(static_cast<int>(i)) = at.x() > margin && at.y() > margin && at.x() < 639 - margin &&
                                   at.y() < 479 - margin && (at - disc).norm() > radius + margin;
  }
  for (int row = 0; row + 1 < kRows; ++row)
    for (int column = 0; column + 1 < kColumns; ++column)
      if (const cv::Rect square(column, row, 2, 2); cv::countNonZero(visible(square)) == 4)
        counted(square) = 1;
  return cv::countNonZero(counted);
}

// OpenCV finds noise-free corners of whole boards to a tenth of a pixel; noise adds to this.
constexpr double kAccurate = 0.35;  // [px], the largest of some forty errors

TEST(Piece, IsFoundAtEachBorderOfThePhotograph) {
  for (const auto& [x, y] : {std::pair(-0.2, 0.0), {0.2, 0.02}, {0.02, -0.17}, {-0.02, 0.17}}) {
    Drawn truth = drawn(x, y, 0.3);
    add_noise(truth.photograph, 5);
    const View view = see_board("a", truth.photograph, kPlain);
    EXPECT_TRUE(view.piece);
    const int found = static_cast<int>(view.corners.size());
    EXPECT_GE(found, count_visible(truth, 15)) << x << " " << y;
    EXPECT_LE(found, count_visible(truth, 0)) << x << " " << y;
    EXPECT_LT(largest_error(view.corners, truth), kAccurate) << x << " " << y;
  }
}

// A disc that reaches into the window in which a corner is sought would move this corner by up to
// ten pixels. The edge of the disc differs from dark or from bright squares, or from both.
TEST(Piece, HasNoCornersThatADiscMoves) {
  for (const std::size_t at : {9u, 27u, 44u})
    for (const double radius : {8.0, 20.0, 45.0})
      for (const double grey : {30.0, 120.0, 210.0}) {
        Drawn truth = drawn(0, 0, 0.42);
        const Eigen::Vector2d disc = truth.corners[at] + Eigen::Vector2d(4, -3);
        cover(truth.photograph, disc, radius, grey);
        add_noise(truth.photograph, 5);
        const Piece piece = find_piece(truth.photograph, kPlain);
        const int found = static_cast<int>(piece.corners.size());
        EXPECT_GE(found, count_visible(truth, 14, disc, radius)) << at << " " << radius;
        EXPECT_LT(found, kColumns * kRows) << at << " " << radius << " " << grey;
        EXPECT_LT(largest_error(piece.corners, truth), kAccurate) << at << " " << radius;
      }
}

// OpenCV's detector finds this board as a whole, with the hidden corner at a place that it guesses.
TEST(Piece, ABoardWithOneHiddenCornerIsAPiece) {
  Drawn truth = drawn(0, 0, 0.42);
  cover(truth.photograph, truth.corners[27], 8, 120);
  const View view = see_board("a", truth.photograph, kPlain);
  EXPECT_TRUE(view.piece);
  EXPECT_EQ(view.corners.size(), corners_of(kPlain).size() - 1);
  EXPECT_LT(largest_error(view.corners, truth), kAccurate);
}

TEST(Piece, IsFoundInHazeAndBlur) {
  Drawn truth = drawn(0.1, 0.05, 0.3);
  cover(truth.photograph, truth.corners[30], 30, 90);
  cv::GaussianBlur(truth.photograph, truth.photograph, {}, 2.5);
  truth.photograph.convertTo(truth.photograph, CV_8U, 0.12, 90);
  add_noise(truth.photograph, 2);
  const View view = see_board("a", truth.photograph, kPlain);
  EXPECT_TRUE(view.piece);
  EXPECT_GE(static_cast<int>(view.corners.size()), count_visible(truth, 20, truth.corners[30], 30));
  EXPECT_LT(largest_error(view.corners, truth), 1.5);  // contrast 24, noise 2, blur 2.5 px
}

// A larger board of the same print has more columns and rows than the named one.
TEST(Piece, HasNoMoreColumnsAndRowsThanTheBoard) {
  const Drawn truth = drawn(0, 0, 0.42);
  const Piece piece = find_piece(truth.photograph, parse_board("checkerboard:5x4:0.03"));
  EXPECT_EQ(piece.columns, 5);
  EXPECT_EQ(piece.rows, 4);
  ASSERT_EQ(piece.corners.size(), 20u);
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(piece.corners[i].number, i);
}

TEST(Piece, BelowThreeByFourCornersIsNamed) {
  // Only the first columns of the board are in the photograph.
  const Drawn truth = drawn(-0.21, 0.0, 0.3, 0);
  ASSERT_GE(count_visible(truth, 15), 4);
  const View view = see_board("a", truth.photograph, kPlain);
  EXPECT_THAT(view.corners, IsEmpty());
  EXPECT_FALSE(view.piece);
  EXPECT_THAT(view.fault, HasSubstr("corners of the checkerboard are found, in "));
  EXPECT_THAT(view.fault, HasSubstr("the least piece has 3 x 4 corners"));
  const cv::Mat1b grey(480, 640, std::uint8_t{128});
  EXPECT_EQ(see_board("a", grey, kPlain).fault, "no checkerboard is found");
}

// Only a board whose squares are not square has two ways to be numbered. The longer side of a piece
// decides, if it is too long for the other way.
TEST(Piece, OfSquaresThatAreNotSquareHasTwoNumberings) {
  const Board uneven = parse_board("checkerboard:8x7:0.03,0.0297");
  Drawn truth = drawn(-0.14, 0.0, 0.3, 0);
  EXPECT_THAT(see_board("a", truth.photograph, kPlain).turned, IsEmpty());
  const View view = see_board("a", truth.photograph, uneven);
  ASSERT_TRUE(view.piece);
  ASSERT_EQ(view.turned.size(), view.corners.size());
  // A neighbour in a row is a neighbour in a column after a quarter of a turn.
  const auto number_at = [](const std::vector<Corner>& corners, const Eigen::Vector2d& pixel) {
    return std::ranges::find(corners, pixel, &Corner::pixel)->number;
  };
  const auto a = number_at(view.turned, view.corners[0].pixel);
  const auto b = number_at(view.turned, view.corners[1].pixel);
  EXPECT_EQ(view.corners[1].number - view.corners[0].number, 1u);
  EXPECT_EQ(std::max(a, b) - std::min(a, b), static_cast<std::size_t>(kColumns));

  Drawn wide = drawn(0, -0.15, 0.4, 0);  // eight columns, and fewer rows
  const View decided = see_board("a", wide.photograph, uneven);
  EXPECT_TRUE(decided.piece);
  EXPECT_THAT(decided.turned, IsEmpty());

  const Drawn whole = drawn(0, 0, 0.42);
  EXPECT_THAT(see_board("a", whole.photograph, uneven).turned, IsEmpty());
}

TEST(Piece, AWholeBoardIsNoPiece) {
  Drawn truth = drawn(0, 0, 0.42);
  add_noise(truth.photograph, 5);
  const View view = see_board("a", truth.photograph, kPlain);
  EXPECT_FALSE(view.piece);
  EXPECT_EQ(view.corners.size(), corners_of(kPlain).size());
  EXPECT_THAT(view.fault, IsEmpty());
}

}  // namespace
}  // namespace axial::calibrate
