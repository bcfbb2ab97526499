// SPDX-License-Identifier: GPL-3.0-or-later
// ChArUco boards, drawn by OpenCV and photographed by a pinhole camera.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>
#include <opencv2/aruco/charuco.hpp>
#include <opencv2/imgproc.hpp>
#include <random>

#include "support/error_of.h"
#include "targets/finders/find_targets.h"

namespace axial::targets {
namespace {

const char* const kBoard = "charuco:7x5:0.04:0.03";
constexpr int kCorners = 24;

cv::Mat1b printed(int pixels_of_square) {
  const auto board = cv::aruco::CharucoBoard::create(
      7, 5, 0.04f, 0.03f, cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50));
  cv::Mat1b print;
  board->draw({7 * pixels_of_square, 5 * pixels_of_square}, print);
  return print;
}

struct BoardView {
  double square = 36;                            // side seen from the front [px]
  double oblique = 0.5, axis = 0.3, turn = 0.2;  // [rad]
  double black = 40, white = 200, blur = 0.6, noise = 2;
  unsigned seed = 1;

  // From squares, from the board's upper left corner, to pixels (COLMAP's convention).
  Eigen::Matrix3d homography() const {
    constexpr double kFocal = 900;
    const Eigen::Matrix3d axes =
        (Eigen::AngleAxisd(oblique, Eigen::Vector3d(std::cos(axis), std::sin(axis), 0)) *
         Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()))
            .toRotationMatrix();
    Eigen::Matrix3d to_camera;
    to_camera << axes.col(0), axes.col(1),
        Eigen::Vector3d(0, 0, kFocal / square) - axes.leftCols<2>() * Eigen::Vector2d(3.5, 2.5);
    Eigen::Matrix3d camera;
    camera << kFocal, 0, 240, 0, kFocal, 180, 0, 0, 1;
    return camera * to_camera;
  }
};

Eigen::Affine2d scaled(double scale, double shift) {
  Eigen::Affine2d result = Eigen::Affine2d::Identity();
  result.linear() *= scale;
  result.translation().setConstant(shift);
  return result;
}

cv::Mat1b photograph(const BoardView& view) {
  constexpr int kSquare = 150, kFine = 4;
  const cv::Size size(480, 360);
  cv::Mat1f light(size * kFine, static_cast<float>(view.white));
  const cv::Mat1b print = printed(kSquare);
  cv::Mat1f brightness;
  print.convertTo(brightness, CV_32F, (view.white - view.black) / 255, view.black);
  // warpPerspective() counts from the centres of pixels.
  const Eigen::Matrix3d warp = scaled(kFine, -0.5).matrix() * view.homography() *
                               scaled(1.0 / kSquare, 0.5 / kSquare).matrix();
  cv::Matx33d matrix;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) matrix(i, k) = warp(i, k);
  cv::warpPerspective(brightness, light, matrix, light.size(), cv::INTER_LINEAR,
                      cv::BORDER_CONSTANT, view.white);
  cv::GaussianBlur(light, light, {}, view.blur * kFine);
  cv::resize(light, light, size, 0, 0, cv::INTER_AREA);
  std::mt19937 random(view.seed);
  std::normal_distribution<float> noise(0, static_cast<float>(view.noise));
  for (float& value : light) value += noise(random);
  cv::Mat1b result;
  light.convertTo(result, CV_8U);
  return result;
}

Eigen::Vector2d place_of(const BoardView& view, std::size_t number) {
  const auto column = static_cast<double>(number % 6 + 1),
             row = static_cast<double>(number / 6 + 1);
  return (view.homography() * Eigen::Vector3d(column, row, 1)).hnormalized();
}

struct BoardConditions {
  double least_square, most_square, haze, most_error;
};

class Charuco : public testing::TestWithParam<BoardConditions> {};

TEST_P(Charuco, CornersAreFoundToASmallPartOfAPixel) {
  constexpr int kCount = 12;
  const BoardConditions& c = GetParam();
  const auto families = parse_families(kBoard);
  std::mt19937 random(7);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  int found = 0;
  double squares = 0, in_sigmas = 0;
  for (int i = 0; i < kCount; ++i) {
    BoardView view{.square = uniform(c.least_square, c.most_square),
                   .oblique = uniform(0, 45) * std::numbers::pi / 180,
                   .axis = uniform(0, 6.28),
                   .turn = uniform(0, 6.28),
                   .seed = static_cast<unsigned>(i)};
    for (double* light : {&view.white, &view.black}) *light = *light * (1 - c.haze) + 127 * c.haze;
    for (const Detection& corner : find_targets(photograph(view), families)) {
      ++found;
      EXPECT_EQ(corner.label, "board corner " + std::to_string(corner.number));
      const Eigen::Vector2d error = corner.centre.pixel - place_of(view, corner.number);
      squares += error.squaredNorm() / 2;
      in_sigmas += (error / corner.centre.sigma).squaredNorm() / 2;
    }
  }
  EXPECT_GE(found, 0.9 * kCount * kCorners);
  EXPECT_LE(found, kCount * kCorners);
  EXPECT_LT(std::sqrt(squares / found), c.most_error);
  EXPECT_GT(std::sqrt(in_sigmas / found), 1 / 1.5);
  EXPECT_LT(std::sqrt(in_sigmas / found), 1.5);
}

INSTANTIATE_TEST_SUITE_P(All, Charuco,
                         testing::Values(BoardConditions{24, 36, 0, 0.1},
                                         BoardConditions{36, 44, 0, 0.1},
                                         BoardConditions{30, 44, 0.7, 0.25}));

TEST(CharucoBoard, MayBeVisibleInPart) {
  const BoardView view;
  const cv::Mat1b part = photograph(view).colRange(0, 270);
  const auto found = find_targets(part, parse_families(kBoard));
  EXPECT_GE(found.size(), 5u);
  EXPECT_LT(found.size(), kCorners);
  for (const Detection& corner : found)
    EXPECT_LT((corner.centre.pixel - place_of(view, corner.number)).norm(), 0.2) << corner.label;
}

TEST(CharucoBoard, IsNotFoundWhereThereIsNone) {
  EXPECT_TRUE(find_targets(cv::Mat1b(200, 300, 128), parse_families(kBoard)).empty());
  EXPECT_THAT(test::error_of([] { parse_families("charuco:7x5:0.04"); }),
              testing::HasSubstr("SQUARE:MARKER"));
  EXPECT_THAT(test::error_of([] { parse_families("charuco:7x5:0.04:0.03,charuco:7x6:0.04:0.03"); }),
              testing::HasSubstr("equal labels"));
}

}  // namespace
}  // namespace axial::targets
