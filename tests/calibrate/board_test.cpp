// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibrate/board.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/aruco/charuco.hpp>

#include "calibrate/board_survey.h"
#include "calibrate/see_board.h"
#include "pose/bundle/bundle.h"
#include "support/error_of.h"
#include "support/photograph.h"

namespace axial::calibrate {
namespace {

using testing::flat_port;
using ::testing::HasSubstr;
using testing::kPinhole;

TEST(Board, IsReadFromItsDescription) {
  const Board checkers = parse_board("checkerboard:9x6:0.03");
  EXPECT_EQ(checkers.kind, BoardKind::checkerboard);
  const auto corners = corners_of(checkers);
  ASSERT_EQ(corners.size(), 54u);
  EXPECT_EQ(corners[10], Eigen::Vector3d(0.03, 0.03, 0));
  EXPECT_EQ(corners_of(parse_board("charuco:8x6:0.03:0.02")).size(), 35u);
  const auto tags = corners_of(parse_board("apriltags:3x2:0.04:0.01"));
  ASSERT_EQ(tags.size(), 24u);
  EXPECT_LT((tags[4 * 4 + 2] - Eigen::Vector3d(0.09, 0.09, 0)).norm(), 1e-15);
  EXPECT_FALSE(has_two_pitches(checkers));
  EXPECT_FALSE(has_two_pitches(parse_board("checkerboard:9x6:0.03,0.03")));
  const Board uneven = parse_board("checkerboard:8x7:0.0338,0.0335");
  EXPECT_TRUE(has_two_pitches(uneven));
  EXPECT_EQ(corners_of(uneven)[9], Eigen::Vector3d(0.0338, 0.0335, 0));
  EXPECT_EQ(parse_board("charuco:8x6:0.03:0.02:5X5_100").dictionary, "5X5_100");
}

TEST(Board, WrongDescriptionsAreNamed) {
  const auto error = [](const std::string& text) {
    return test::error_of([&] { parse_board(text); });
  };
  EXPECT_THAT(error(""), HasSubstr("must begin with checkerboard:"));
  EXPECT_THAT(error("chess:9x6:0.03"), HasSubstr("chess:9x6:0.03: must begin with"));
  EXPECT_THAT(error("checkerboard:9x6"), HasSubstr("COLUMNSxROWS:SQUARE"));
  EXPECT_THAT(error("checkerboard:9:0.03"), HasSubstr("'9' is not COLUMNSxROWS"));
  EXPECT_THAT(error("checkerboard:9x2:0.03"), HasSubstr("9 columns and 2 rows"));
  EXPECT_THAT(error("checkerboard:9x6:30"), HasSubstr("'30' is not a length in metres"));
  EXPECT_THAT(error("checkerboard:9x6:nan"), HasSubstr("'nan' is not a length"));
  EXPECT_THAT(error("checkerboard:9x6:3cm"), HasSubstr("'3cm' is not a number"));
  EXPECT_THAT(error("checkerboard:9x6:0.03,"), HasSubstr("is neither SQUARE nor WIDTH,HEIGHT"));
  EXPECT_THAT(error("checkerboard:9x6:0.03,0.03,0.03"), HasSubstr("is neither SQUARE nor"));
  EXPECT_THAT(error("checkerboard:9x6:0.03,x"), HasSubstr("'x' is not a number"));
  EXPECT_THAT(error("checkerboard:9x6:0.03,0.3"), HasSubstr("0.03 x 0.3 m are not nearly square"));
  EXPECT_THAT(error("charuco:8x6:0.03"), HasSubstr("SQUARE:MARKER"));
  EXPECT_THAT(error("charuco:8x6:0.03:0.04"), HasSubstr("does not fit into a square"));
  EXPECT_THAT(error("charuco:8x6:0.03:0.02:9X9"),
              HasSubstr("'9X9' is not a dictionary of markers of OpenCV"));
  EXPECT_THAT(error("charuco:20x20:0.03:0.02"), HasSubstr("200 markers, but"));
}

// A pose with a large and tilted board in the image, behind the port.
Pose pose_before(const Board& board) {
  const auto corners = corners_of(board);
  const Eigen::Vector3d middle = (corners.front() + corners.back()) / 2;
  Pose pose;
  pose.rotation =
      Eigen::AngleAxisd(0.4, Eigen::Vector3d(0.5, 0.8, 0.1).normalized()).toRotationMatrix();
  pose.centre = middle - pose.rotation.transpose() * Eigen::Vector3d(0.02, -0.01, 0.35);
  return pose;
}

TEST(SeeBoard, OfACheckerboardAreWhereTheExactProjectionPutsThem) {
  const Board board = testing::kBoard;
  const Pose pose = pose_before(board);
  const auto camera = testing::camera_of(kPinhole, flat_port());
  const cv::Mat1b image =
      test::photograph(camera, pose, test::checkerboard(board.columns, board.rows, board.size));
  const auto found = see_board("", image, board).corners;
  const auto expected =
      testing::seen_corners(kPinhole, flat_port(), pose, board, testing::SurveyOptions().within);
  ASSERT_EQ(found.size(), 54u);
  ASSERT_EQ(expected.size(), 54u);
  // The board looks the same if it is rotated by 180 degrees.
  const bool same_way = (found[0].pixel - expected[0].pixel).norm() < 100;
  double sum2 = 0;
  for (std::size_t i = 0; i < 54; ++i)
    sum2 += (found[i].pixel - expected[same_way ? i : 53 - i].pixel).squaredNorm();
  // OpenCV finds noise-free corners to a tenth of a pixel or better.
  EXPECT_LT(std::sqrt(sum2 / 54), 0.1);
}

TEST(SeeBoard, NoneInAnEmptyPhotograph) {
  const cv::Mat1b grey(480, 640, static_cast<unsigned char>(128));
  EXPECT_TRUE(see_board("", grey, testing::kBoard).corners.empty());
  EXPECT_TRUE(see_board("", grey, parse_board("charuco:8x6:0.03:0.02")).corners.empty());
  EXPECT_TRUE(see_board("", grey, parse_board("apriltags:4x3:0.04:0.01")).corners.empty());
}

// Boards of markers may be visible in part: every corner lies where the exact projection images the
// corner with its number.
struct Errors {
  double rms = 0, largest = 0;                     // [px]
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();  // common shift: poses and ports absorb it
};

Errors errors_behind_port(const Board& board, const cv::Mat1b& print, double width, double height,
                          std::size_t least_corners) {
  Pose pose;
  pose.rotation =
      Eigen::AngleAxisd(0.4, Eigen::Vector3d(0.5, 0.8, 0.1).normalized()).toRotationMatrix();
  const CameraModel model = testing::camera_of(kPinhole, flat_port());
  const auto camera = make_camera<double>(model);
  const auto corners = corners_of(board);
  std::vector<double> errors;
  Eigen::Vector2d sum(0, 0);
  for (const double aside : {-0.06, 0.0, 0.12}) {
    pose.centre = Eigen::Vector3d(width / 2, height / 2, 0) -
                  pose.rotation.transpose() * Eigen::Vector3d(aside, 0.01, 0.3);
    const cv::Mat1b image = test::photograph(model, pose, test::picture(print, width, height));
    const auto found = see_board("", image, board).corners;
    EXPECT_GE(found.size(), least_corners);
    if (found.empty()) return {1e9, 1e9, {1e9, 1e9}};
    for (const Corner& corner : found) {
      const Eigen::Vector3d place = pose.to_camera(corners.at(corner.number));
      const auto exact = std::visit([&](const auto& c) { return c.project(place); }, camera);
      errors.push_back((corner.pixel - exact.pixel).norm());
      sum += corner.pixel - exact.pixel;
    }
  }
  return {pose::root_mean_square(errors), *std::ranges::max_element(errors),
          sum / static_cast<double>(errors.size())};
}

TEST(SeeBoard, OfACharucoBoardAreWhereTheExactProjectionPutsThem) {
  const Board board = parse_board("charuco:8x6:0.025:0.018");
  const auto printed = cv::aruco::CharucoBoard::create(
      8, 6, 0.025f, 0.018f, cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50));
  cv::Mat print;
  printed->draw({1600, 1200}, print);
  const Errors errors = errors_behind_port(board, print, 0.2, 0.15, 20);
  // Windows that do not reach a marker are small and sample the edges coarsely, in thirds of a
  // pixel.
  EXPECT_LT(errors.rms, 0.15);
  EXPECT_LT(errors.largest, 0.4);
  EXPECT_LT(errors.mean.norm(), 0.05);
}

TEST(SeeBoard, OfAprilTagsAreWhereTheExactProjectionPutsThem) {
  const Board board = parse_board("apriltags:5x4:0.03:0.01");
  const auto printed = cv::aruco::GridBoard::create(
      5, 4, 0.03f, 0.01f, cv::aruco::getPredefinedDictionary(cv::aruco::DICT_APRILTAG_36h11));
  cv::Mat print;
  printed->draw({1900, 1500}, print);
  const Errors errors = errors_behind_port(board, print, 0.19, 0.15, 40);
  // A tag's corner is the corner of a single dark area, and blur moves it.
  EXPECT_LT(errors.rms, 0.3);
  EXPECT_LT(errors.largest, 0.6);
  EXPECT_LT(errors.mean.norm(), 0.05);
}

}  // namespace
}  // namespace axial::calibrate
