// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibrate/calibrate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calibrate/board_survey.h"
#include "calibrate/information.h"
#include "drawn.h"
#include "support/error_of.h"

namespace axial::calibrate {
namespace {

using refractive::DomePort;
using refractive::FlatPort;
using testing::angle_degrees;
using testing::dome_port;
using testing::flat_port;
using ::testing::HasSubstr;
using testing::kBoard;
using testing::kDistorting;
using testing::kPinhole;
using testing::kUsual;
using testing::kUsualBoard;
using testing::survey;

CalibrateOptions unknown(std::initializer_list<std::size_t> numbers) {
  CalibrateOptions options;
  for (const std::size_t number : numbers) options.adjust.free[number] = true;
  return options;
}

std::vector<std::string> names_of(const std::vector<LeftOut>& left_out) {
  std::vector<std::string> names;
  for (const LeftOut& photograph : left_out) names.push_back(photograph.image);
  return names;
}

const std::initializer_list<std::size_t> kPlace{0, 1, 2};  // normal and distance, or centre

template <class Port>
Port found_port(const Calibration& calibration) {
  return std::get<Port>(*calibration.camera().now().port);
}

// A port with errors of half a centimetre and 1.5 degrees.
FlatPort<double> rough_flat_port() {
  return flat_port(0, 0.03);
}

class CalibrateWith : public ::testing::TestWithParam<io::ColmapCamera> {};

// The remaining errors are the lens's inversion, with a relative error of 1e-9, and rounding.
TEST_P(CalibrateWith, FindsAFlatPortExactlyInPerfectPhotographs) {
  const auto taken = survey(GetParam(), flat_port());
  const Calibration found =
      calibrate(GetParam(), rough_flat_port(), taken.views, corners_of(kBoard), unknown(kPlace));
  const auto port = found_port<FlatPort<double>>(found);
  EXPECT_NEAR(port.distance, 0.025, 1e-7);
  EXPECT_LT(angle_degrees(port.normal, flat_port().normal), 1e-5);
  ASSERT_EQ(found.views.size(), 25u);
  for (std::size_t i = 0; i < taken.poses.size(); ++i)
    EXPECT_LT((found.bundle.bundle.images[i].pose.centre - taken.poses[i].centre).norm(), 1e-6);
  EXPECT_LT(pose::root_mean_square(reprojection_errors(found.bundle.bundle)), 1e-5);
}

TEST_P(CalibrateWith, FindsADomeExactlyInPerfectPhotographs) {
  const auto taken = survey(GetParam(), dome_port());
  DomePort<double> rough = dome_port();
  rough.centre.setZero();
  const Calibration found =
      calibrate(GetParam(), rough, taken.views, corners_of(kBoard), unknown(kPlace));
  EXPECT_LT((found_port<DomePort<double>>(found).centre - dome_port().centre).norm(), 1e-7);
}

INSTANTIATE_TEST_SUITE_P(Lenses, CalibrateWith, ::testing::Values(kPinhole, kDistorting),
                         [](const auto& tested) { return tested.param.model; });

// The standard deviations in docs/calibration.md: another random noise changes them by less.
void expect_sigmas(const Calibration& calibration, double normal_degrees, double distance) {
  const auto& sigmas = calibration.uncertainty.camera_sigmas[0];
  EXPECT_NEAR(std::max(sigmas(0), sigmas(1)) / testing::kDegree, normal_degrees,
              0.25 * normal_degrees);
  EXPECT_NEAR(sigmas(2), distance, 0.25 * distance);
}

TEST(Calibrate, FindsThePortToHalfAMillimetreInTwentyFiveNoisyPhotographs) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const auto taken =
        survey(kUsual, flat_port(), {.steepest = 45, .noise = 0.2, .seed = seed}, kUsualBoard);
    const Calibration found =
        calibrate(kUsual, rough_flat_port(), taken.views, corners_of(kUsualBoard), unknown(kPlace));
    const auto port = found_port<FlatPort<double>>(found);
    EXPECT_NEAR(port.distance, 0.025, 0.0005) << seed;
    EXPECT_LT(angle_degrees(port.normal, flat_port().normal), 0.05) << seed;
    EXPECT_NEAR(found.uncertainty.pixel_sigma, 0.2, 0.02) << seed;
    expect_sigmas(found, 0.013, 0.0001);
  }
}

TEST(Calibrate, KnowsThePortWorseFromFewerPixelsAndCorners) {
  const auto taken = survey(kPinhole, flat_port(), {.steepest = 45, .noise = 0.2});
  expect_sigmas(
      calibrate(kPinhole, rough_flat_port(), taken.views, corners_of(kBoard), unknown(kPlace)),
      0.06, 0.0004);
}

TEST(Calibrate, FindsADomeToHalfAMillimetreInTwentyFiveNoisyPhotographs) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const auto taken = survey(kPinhole, dome_port(), {.noise = 0.2, .seed = seed});
    DomePort<double> rough = dome_port();
    rough.centre.setZero();
    const Calibration found =
        calibrate(kPinhole, rough, taken.views, corners_of(kBoard), unknown(kPlace));
    EXPECT_LT((found_port<DomePort<double>>(found).centre - dome_port().centre).norm(), 0.0005)
        << seed;
  }
}

// Many calibrations that differ in noise alone scatter as their standard deviations predict.
TEST(Calibrate, StandardDeviationsAreHonest) {
  constexpr int kRuns = 30;
  const auto exact = survey(kPinhole, flat_port(), {.views = 10});
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0, 0.3);
  CalibrateOptions options = unknown(kPlace);
  options.adjust.loss_sigmas = 100;
  pose::HousingChange<double> sum2 = pose::HousingChange<double>::Zero(), predicted2 = sum2;
  for (int run = 0; run < kRuns; ++run) {
    std::vector<View> views = exact.views;
    for (View& view : views)
      for (Corner& corner : view.corners) corner.pixel += axial::test::drawn<2>(noise, random);
    const Calibration found = calibrate(kPinhole, flat_port(), views, corners_of(kBoard), options);
    sum2 += found.camera().change.cwiseAbs2();
    predicted2 += found.uncertainty.camera_sigmas[0].cwiseAbs2();
  }
  // The ratio of a sum of 30 squares to its expectation scatters by sqrt(2/30) = 26 %; three times
  // this is allowed.
  for (int k = 0; k < 3; ++k) {
    EXPECT_GT(sum2(k) / predicted2(k), 0.3) << k;
    EXPECT_LT(sum2(k) / predicted2(k), 1.9) << k;
  }
  for (int k = 3; k < pose::kHousingNumbers; ++k) EXPECT_EQ(sum2(k) + predicted2(k), 0) << k;
}

// Two ways to the same numbers: the normal equations at once, or one photograph after the other.
TEST(Calibrate, WhatPhotographsTellAddsUp) {
  const auto taken = survey(kPinhole, flat_port(), {.views = 8, .noise = 0.2});
  CalibrateOptions options = unknown({0, 1, 2, pose::kThicknessNumber});
  options.adjust.prior_sigma[pose::kThicknessNumber] = 0.0005;
  options.adjust.loss_sigmas = 100;
  const Calibration found =
      calibrate(kPinhole, flat_port(), taken.views, corners_of(kBoard), options);
  const double noise = found.uncertainty.pixel_sigma;
  const auto sigmas =
      sigmas_from(total_information(found.bundle.bundle, found.adjust, noise), found.adjust);
  const auto& expected = found.uncertainty.camera_sigmas[0];
  for (int k = 0; k < pose::kHousingNumbers; ++k)
    EXPECT_NEAR(sigmas(k), expected(k), 1e-4 * expected(k)) << k;
}

// Glass and gap have similar effects: the thickness stays about as precise as it was measured.
TEST(Calibrate, AMeasuredThicknessStaysAboutAsItWasMeasured) {
  const auto taken = survey(kPinhole, flat_port(), {.noise = 0.2});
  FlatPort<double> rough = rough_flat_port();
  rough.thickness = 0.0103;
  CalibrateOptions options = unknown({0, 1, 2, pose::kThicknessNumber});
  options.adjust.prior_sigma[pose::kThicknessNumber] = 0.0003;
  const Calibration found = calibrate(kPinhole, rough, taken.views, corners_of(kBoard), options);
  const auto& sigmas = found.uncertainty.camera_sigmas[0];
  EXPECT_LE(sigmas(pose::kThicknessNumber), 0.0003 * 1.0001);
  EXPECT_GT(sigmas(pose::kThicknessNumber), 0.0001);
  const auto port = found_port<FlatPort<double>>(found);
  EXPECT_NEAR(port.thickness, 0.01, 4 * sigmas(pose::kThicknessNumber));
  EXPECT_NEAR(port.distance, 0.025, 4 * sigmas(2));
}

TEST(Calibrate, FindsTheIndexOfTheWater) {
  const auto taken = survey(kPinhole, flat_port(), {.noise = 0.1});
  FlatPort<double> rough = rough_flat_port();
  rough.n_water = 1.34;
  const Calibration found = calibrate(kPinhole, rough, taken.views, corners_of(kBoard),
                                      unknown({0, 1, 2, pose::kIndexNumber}));
  const double sigma = found.uncertainty.camera_sigmas[0](pose::kIndexNumber);
  EXPECT_NEAR(found_port<FlatPort<double>>(found).n_water, 1.334, 4 * sigma);
  EXPECT_LT(sigma, 0.005);
}

TEST(Calibrate, LeavesOutWhatDoesNotFit) {
  auto taken = survey(kPinhole, flat_port(), {.noise = 0.2});
  for (std::size_t i = 0; i < taken.views[3].corners.size(); i += 9)
    taken.views[3].corners[i].pixel.x() += 30;  // some wrong corners
  std::swap(taken.views[7].corners[10].pixel, taken.views[7].corners[30].pixel);
  taken.views[9].corners.resize(5);
  const Calibration found =
      calibrate(kPinhole, rough_flat_port(), taken.views, corners_of(kBoard), unknown(kPlace));
  EXPECT_EQ(names_of(found.left_out), std::vector<std::string>{"view9.png"});
  EXPECT_EQ(found.left_out[0].reason, "5 corners of the board are found, at least 8 are needed");
  EXPECT_EQ(found.bundle.bundle.observations.size(), 24u * 54 - 6 - 2);
  EXPECT_NEAR(found_port<FlatPort<double>>(found).distance, 0.025, 0.0005);
}

TEST(Calibrate, RefusesTooFewPhotographs) {
  auto taken = survey(kPinhole, flat_port(), {.views = 3});
  taken.views[1].corners.clear();
  taken.views[1].fault = "no checkerboard is found";
  const std::string error = test::error_of(
      [&] { calibrate(kPinhole, flat_port(), taken.views, corners_of(kBoard), unknown(kPlace)); });
  EXPECT_THAT(error, HasSubstr("2 photographs show 8 or more corners of the board, at least 3"));
  EXPECT_THAT(error, HasSubstr("near and far; view1.png: no checkerboard is found"));
}

// Directions beyond the fold of a lens model have no image.
TEST(Calibrate, LeavesOutWhatDoesNotTellWhereTheBoardIs) {
  const io::ColmapCamera folding{1, "SIMPLE_RADIAL", 1024, 768, {610, 512, 384, -0.3}};
  auto taken =
      survey(folding, flat_port(),
             {.views = 5, .within = {Eigen::Vector2d(0.3, 0.2), Eigen::Vector2d(0.7, 0.8)}});
  View beyond{"beyond.png", {}}, in_one_place{"point.png", {}};
  for (const std::size_t number : {0u, 1u, 2u, 9u, 10u, 11u, 18u, 19u, 20u}) {
    const auto column = static_cast<double>(number % 9), row = static_cast<double>(number / 9);
    beyond.corners.push_back({number, {5 + 8 * column, 5 + 8 * row}});
    in_one_place.corners.push_back({number, {500, 300}});
  }
  taken.views.insert(taken.views.begin() + 2, {beyond, in_one_place});
  const Calibration found =
      calibrate(folding, flat_port(), taken.views, corners_of(kBoard), unknown(kPlace));
  EXPECT_EQ(names_of(found.left_out), (std::vector<std::string>{"beyond.png", "point.png"}));
  ASSERT_EQ(found.views.size(), 5u);
  EXPECT_NEAR(found_port<FlatPort<double>>(found).distance, 0.025, 1e-6);
}

// A distant plane looks nearly the same in two poses. Behind a port far from central, two of these
// boards look more like the wrong pose until the exact projection is used.
TEST(Calibrate, PlacesBoardsOnTheRightOneOfTheirTwoSides) {
  const auto port = flat_port(25, 0.3);
  const auto taken =
      survey(kPinhole, port, {.views = 20, .nearest = 1.6, .farthest = 2.4, .steepest = 45});
  const Calibration found = calibrate(kPinhole, port, taken.views, corners_of(kBoard), unknown({}));
  ASSERT_EQ(found.views.size(), 20u);
  for (std::size_t i = 0; i < taken.poses.size(); ++i)
    EXPECT_LT((found.bundle.bundle.images[i].pose.centre - taken.poses[i].centre).norm(), 1e-4)
        << i;
}

// The corners of some columns and rows, with the numbers of a piece.
View piece_in(const View& view, const Board& board, const Eigen::AlignedBox2i& cells) {
  View piece{view.image, {}, true};
  for (const Corner& corner : view.corners) {
    const int number = static_cast<int>(corner.number);
    const Eigen::Vector2i cell(number % board.columns, number / board.columns);
    if (!cells.contains(cell)) continue;
    const Eigen::Vector2i moved = cell - cells.min();
    piece.corners.push_back(
        {static_cast<std::size_t>(moved.y() * board.columns + moved.x()), corner.pixel});
  }
  return piece;
}

Eigen::AlignedBox2i cells(int left, int top, int right, int bottom) {
  return {Eigen::Vector2i(left, top), Eigen::Vector2i(right, bottom)};
}

// A place on the board that is not known does not matter.
TEST(Calibrate, FindsAPortExactlyByPiecesInPerfectPhotographs) {
  auto taken = survey(kPinhole, flat_port(), {.views = 12});
  for (std::size_t i = 0; i < 12; i += 2) {
    const auto part = i % 4 == 0 ? cells(3, 1, 8, 4) : cells(2, 2, 4, 5);
    taken.views[i] = piece_in(taken.views[i], kBoard, part);
  }
  const Calibration found =
      calibrate(kPinhole, rough_flat_port(), taken.views, corners_of(kBoard), unknown(kPlace));
  EXPECT_EQ(found.pieces(), 6u);
  EXPECT_TRUE(found.left_out.empty());
  const auto port = found_port<FlatPort<double>>(found);
  EXPECT_NEAR(port.distance, 0.025, 1e-7);
  EXPECT_LT(angle_degrees(port.normal, flat_port().normal), 1e-5);
}

// Pieces with a skipped row or column, and one whose columns and rows are confused.
TEST(Calibrate, LeavesOutWrongPieces) {
  auto taken = survey(kPinhole, flat_port(), {.views = 12, .noise = 0.2});
  View& skipped = taken.views[2];
  skipped = piece_in(skipped, kBoard, cells(1, 0, 5, 5));
  std::erase_if(skipped.corners, [](const Corner& corner) { return corner.number / 9 == 2; });
  for (Corner& corner : skipped.corners)
    if (corner.number / 9 > 2) corner.number -= 9;
  View& sheared = taken.views[5];
  sheared = piece_in(sheared, kBoard, cells(0, 0, 4, 3));
  for (Corner& corner : sheared.corners) corner.number += corner.number / 9;
  View& right = taken.views[7];
  right = piece_in(right, kBoard, cells(0, 0, 3, 2));
  const Calibration found =
      calibrate(kPinhole, rough_flat_port(), taken.views, corners_of(kBoard), unknown(kPlace));
  ASSERT_EQ(names_of(found.left_out), (std::vector<std::string>{"view2.png", "view5.png"}));
  EXPECT_EQ(found.left_out[0].reason, "its corners are not a regular piece of the board");
  EXPECT_EQ(found.pieces(), 1u);
  EXPECT_NEAR(found_port<FlatPort<double>>(found).distance, 0.025,
              4 * found.uncertainty.camera_sigmas[0](2));
}

// A print that is 1 % wider than high. Each piece is first numbered in the wrong way.
TEST(Calibrate, TurnsPiecesOfSquaresThatAreNotSquare) {
  const Board board = parse_board("checkerboard:9x6:0.025,0.02475");
  auto taken = survey(kPinhole, flat_port(), {.views = 14, .noise = 0.1}, board);
  for (std::size_t i = 0; i < 7; ++i) {
    View& view = taken.views[i];
    view = piece_in(view, board, cells(2, 0, 7, 5));
    view.turned = view.corners;
    for (Corner& corner : view.corners)
      corner.number = 9 * (5 - corner.number % 9) + corner.number / 9;
  }
  const Calibration found =
      calibrate(kPinhole, rough_flat_port(), taken.views, corners_of(board), unknown(kPlace));
  ASSERT_EQ(found.views.size(), 14u);
  for (std::size_t i = 0; i < 7; ++i) EXPECT_EQ(found.views[i].corners[1].number, 1u) << i;
  EXPECT_NEAR(found_port<FlatPort<double>>(found).distance, 0.025,
              4 * found.uncertainty.camera_sigmas[0](2));
  EXPECT_NEAR(found.uncertainty.pixel_sigma, 0.1, 0.01);
}

// Corners on one line leave the rotation about that line open.
TEST(Calibrate, ARowOfCornersIsNoBoard) {
  auto taken = survey(kPinhole, flat_port(), {.views = 4});
  taken.views[2].corners.resize(9);
  const Calibration found =
      calibrate(kPinhole, flat_port(), taken.views, corners_of(kBoard), unknown(kPlace));
  EXPECT_EQ(names_of(found.left_out), std::vector<std::string>{"view2.png"});
}

}  // namespace
}  // namespace axial::calibrate
