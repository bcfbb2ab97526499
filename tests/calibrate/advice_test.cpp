// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibrate/advice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "calibrate/board_survey.h"
#include "calibrate/information.h"
#include "drawn.h"
#include "support/error_of.h"

namespace axial::calibrate {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using testing::flat_port;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::kBoard;
using testing::kPinhole;
using ::testing::Not;
using testing::survey;
using testing::SurveyOptions;

Calibration calibrated(const SurveyOptions& taken) {
  CalibrateOptions options;
  options.adjust.free = {true, true, true};
  return calibrate(kPinhole, flat_port(), survey(kPinhole, flat_port(), taken).views,
                   corners_of(kBoard), options);
}

std::string refusal(const SurveyOptions& taken) {
  const Calibration found = calibrated(taken);
  return test::error_of([&] { require_known(found, Limits()); });
}

Eigen::AlignedBox2d box(double left, double top, double right, double bottom) {
  return {Eigen::Vector2d(left, top), Eigen::Vector2d(right, bottom)};
}

TEST(Advice, AGoodSetNeedsNone) {
  const Calibration found = calibrated({.noise = 0.2});
  EXPECT_THAT(gaps(found), IsEmpty());
  EXPECT_NO_THROW(require_known(found, Limits()));
}

TEST(Advice, NamesTheEdgeThatNoPhotographReaches) {
  EXPECT_THAT(gaps(calibrated({.within = box(0.2, 0.01, 0.99, 0.99)})),
              ElementsAre("corners near the image's left edge"));
  EXPECT_THAT(gaps(calibrated({.within = box(0.01, 0.01, 0.8, 0.99)})),
              ElementsAre("corners near the image's right edge"));
  EXPECT_THAT(gaps(calibrated({.within = box(0.01, 0.2, 0.99, 0.99)})),
              ElementsAre("corners near the image's upper edge"));
  EXPECT_THAT(gaps(calibrated({.within = box(0.01, 0.01, 0.99, 0.8)})),
              ElementsAre("corners near the image's lower edge"));
}

TEST(Advice, NamesThatNoBoardIsTilted) {
  EXPECT_THAT(gaps(calibrated({.views = 15, .steepest = 5, .noise = 0.1})),
              Contains("a board tilted by 20 degrees or more"));
}

TEST(Advice, NamesThatAllDistancesAreOne) {
  EXPECT_THAT(gaps(calibrated({.nearest = 0.36, .farthest = 0.38})),
              Contains(HasSubstr("a distance other than 0.3")));
}

TEST(Advice, RefusesBoardsInTheMiddleOfTheImageAndSaysWhatIsMissing) {
  const std::string said = refusal(
      {.views = 5, .nearest = 0.8, .farthest = 1, .noise = 0.2, .within = box(0.3, 0.3, 0.7, 0.7)});
  EXPECT_THAT(said, HasSubstr("5 photographs determine the "));
  for (const char* edge : {"left", "right", "upper", "lower"})
    EXPECT_THAT(said, HasSubstr(std::string("corners near the image's ") + edge + " edge"));
  EXPECT_THAT(said, HasSubstr("the most useful next photograph shows the board at the image's "));
  EXPECT_THAT(said, Not(HasSubstr("tilted by")));  // the boards are tilted
  EXPECT_THAT(said, Not(HasSubstr("\n")));
}

TEST(Advice, RefusesBoardsThatAllFaceTheCamera) {
  const std::string said = refusal({.views = 3,
                                    .nearest = 0.8,
                                    .farthest = 0.81,
                                    .steepest = 1,
                                    .noise = 0.2,
                                    .within = box(0.25, 0.25, 0.75, 0.75)});
  EXPECT_THAT(said, HasSubstr("a board tilted by 20 degrees or more"));
  EXPECT_THAT(said, HasSubstr("nor a distance other than 0."));
}

// A piece at an unknown place of the board is where its corners are, not where a whole board would
// be.
TEST(Advice, ThePlaceOfAPieceIsTheMiddleOfItsCorners) {
  auto taken = survey(kPinhole, flat_port(), {.views = 6});
  std::vector<Eigen::Vector3d> middles;
  for (std::size_t i = 0; i < taken.views.size(); ++i) {
    View& view = taken.views[i];
    std::erase_if(view.corners, [](const Corner& corner) { return corner.number % 9 < 5; });
    view.piece = true;
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (Corner& corner : view.corners) {
      middle += corners_of(kBoard)[corner.number] / static_cast<double>(view.corners.size());
      corner.number -= 5;
    }
    middles.push_back(taken.poses[i].to_camera(middle));
  }
  CalibrateOptions options;
  options.adjust.free = {true, true, true};
  const Calibration found =
      calibrate(kPinhole, flat_port(), taken.views, corners_of(kBoard), options);
  ASSERT_EQ(found.pieces(), 6u);
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_NEAR(board_place(found.bundle.bundle, i, found.views[i]).distance, middles[i].norm(),
                1e-6);
}

// Few photographs, all with the board in the middle.
Calibration in_need_of_advice() {
  return calibrated({.views = 5,
                     .nearest = 0.5,
                     .farthest = 0.8,
                     .noise = 0.2,
                     .within = box(0.2, 0.2, 0.8, 0.8)});
}

// Adds the advised photograph and compares the standard deviations with the prediction.
TEST(Advice, TheNextPhotographHelpsAsPromised) {
  const Calibration found = in_need_of_advice();
  const auto next = next_photograph(found, Limits());
  ASSERT_TRUE(next);
  std::vector<View> views = found.views;
  views.push_back({"next.png", next->board.corners});
  std::vector<Pose> poses;
  for (const pose::BundleImage& image : found.bundle.bundle.images) poses.push_back(image.pose);
  poses.push_back(next->board.pose);
  const auto with =
      board_bundle(kPinhole, *found.camera().now().port, views, corners_of(kBoard), poses);
  pose::AdjustOptions options = found.adjust;
  const auto before = sigmas_from(
      total_information(found.bundle.bundle, options, found.uncertainty.pixel_sigma), options);
  const auto after =
      sigmas_from(total_information(with.bundle, options, found.uncertainty.pixel_sigma), options);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(after(k), next->sigmas(k), 1e-3 * after(k)) << k;
    EXPECT_LE(after(k), before(k)) << k;
  }
  EXPECT_LT((after.head<3>().cwiseQuotient(before.head<3>())).minCoeff(), 0.8);
}

// The largest ratio of a standard deviation to its limit, for noise of 1 px.
double worst_for_a_pixel(const Calibration& calibration) {
  const Limits limits;
  const auto& sigmas = calibration.uncertainty.camera_sigmas[0];
  return std::max(
             {sigmas(0) / limits.normal, sigmas(1) / limits.normal, sigmas(2) / limits.place}) /
         calibration.uncertainty.pixel_sigma;
}

// Adds the advised photograph, or another one, as the true camera takes it, with noise, and
// calibrates again.
TEST(Advice, NoOtherPhotographHelpsMuchMoreOnceTaken) {
  const Calibration found = in_need_of_advice();
  const auto next = next_photograph(found, Limits());
  ASSERT_TRUE(next);
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0, 0.2);
  CalibrateOptions options;
  options.adjust.free = {true, true, true};
  const auto taken = [&](const PlacedBoard& board) -> std::optional<Calibration> {
    View view{"next.png",
              testing::seen_corners(kPinhole, flat_port(), board.pose, kBoard, box(0, 0, 1, 1))};
    if (view.corners.empty()) return {};
    for (Corner& corner : view.corners) corner.pixel += axial::test::drawn<2>(noise, random);
    std::vector<View> views = found.views;
    views.push_back(view);
    return calibrate(kPinhole, flat_port(), views, corners_of(kBoard), options);
  };
  const auto advised = taken(next->board);
  ASSERT_TRUE(advised);
  const auto& sigmas = advised->uncertainty.camera_sigmas[0];
  // The board is placed for the calibrated port, which differs a little from the true one, and
  // noise changes the poses. Both change the standard deviations by a few percent.
  constexpr double kElsewhere = 0.05;
  for (int k = 0; k < 3; ++k) {
    const double promised = next->sigmas(k) / found.uncertainty.pixel_sigma;
    const double kept = sigmas(k) / advised->uncertainty.pixel_sigma;
    EXPECT_NEAR(kept, promised, kElsewhere * promised) << k;
  }
  double nearest = 1e9;
  for (std::size_t i = 0; i < found.views.size(); ++i)
    nearest = std::min(nearest, board_place(found.bundle.bundle, i, found.views[i]).distance);
  std::vector<double> others;
  const auto boards = placed_boards(found.bundle, corners_of(kBoard), 0.8 * nearest);
  for (std::size_t i = 0; i < boards.size(); i += 4)
    if (const auto other = taken(boards[i])) others.push_back(worst_for_a_pixel(*other));
  ASSERT_GT(others.size(), 15u);
  std::ranges::sort(others);
  const double worst = worst_for_a_pixel(*advised);
  EXPECT_LT(worst, (1 + kElsewhere) * others.front());
  // Random advice would do no better than the median.
  EXPECT_LT(worst, 0.8 * others[others.size() / 2]);
}

// A board that is named as at an edge is there, and completely visible.
TEST(PlacedBoards, AreWhereTheyAreSaidToBe) {
  const Calibration found = calibrated({.views = 5});
  const auto boards = placed_boards(found.bundle, corners_of(kBoard), 0.2);
  EXPECT_GT(boards.size(), 50u);
  for (const PlacedBoard& board : boards) {
    double left = 1e9, right = 0, upper = 1e9, lower = 0;
    for (const Corner& corner : board.corners) {
      left = std::min(left, corner.pixel.x());
      right = std::max(right, corner.pixel.x());
      upper = std::min(upper, corner.pixel.y());
      lower = std::max(lower, corner.pixel.y());
    }
    EXPECT_EQ(board.corners.size(), 54u);
    if (board.column < 0) {
      EXPECT_LT(left, 60) << words_for(board);
    }
    if (board.column > 0) {
      EXPECT_GT(right, 1023 - 60) << words_for(board);
    }
    if (board.row < 0) {
      EXPECT_LT(upper, 60) << words_for(board);
    }
    if (board.row > 0) {
      EXPECT_GT(lower, 767 - 60) << words_for(board);
    }
    const auto depth = [&](std::size_t corner) {
      return board.pose.to_camera(corners_of(kBoard)[corner]).z();
    };
    // Corner 0 is the upper left one, corner 8 the upper right, corner 45 the lower left.
    const double nearer_right = depth(0) - depth(8), nearer_below = depth(0) - depth(45);
    EXPECT_EQ(board.turned, nearer_right > 0.01 ? 1 : nearer_right < -0.01 ? -1 : 0);
    EXPECT_EQ(board.tipped, nearer_below > 0.01 ? 1 : nearer_below < -0.01 ? -1 : 0);
  }
}

// The share of the image's half width at which a ray is imaged, if `share` is its place for a port
// that magnifies everywhere as in the middle. By Snell's law, for a distant scene.
double share_of_a_far_board(double share) {
  const double half = 512 / 610.0, n_water = 1.334;
  const double in_water = std::atan(share * half / n_water);
  return std::tan(std::asin(n_water * std::sin(in_water))) / half;
}

// The distances are computed from the rays in the middle of the image. A port magnifies more
// towards the edges, and most for a distant board.
TEST(PlacedBoards, FillTheSharesOfTheImageThatTheirDistancesAreFor) {
  const Calibration found = calibrated({.views = 5});
  std::vector<double> shares;
  for (const PlacedBoard& board : placed_boards(found.bundle, corners_of(kBoard), 0.01)) {
    if (board.column != 0 || board.row != 0 || board.turned != 0 || board.tipped != 0) continue;
    Eigen::AlignedBox2d seen;
    for (const Corner& corner : board.corners) seen.extend(corner.pixel);
    const Eigen::Array2d image(static_cast<double>(kPinhole.width),
                               static_cast<double>(kPinhole.height));
    shares.push_back((seen.sizes().array() / image).maxCoeff());
  }
  ASSERT_EQ(shares.size(), 2u);
  constexpr double kTilted = 0.01;  // effect of the port's tilt
  for (const auto& [share, wanted] : {std::pair(shares[0], 0.8), std::pair(shares[1], 0.4)}) {
    EXPECT_GT(share, (1 - kTilted) * wanted);
    EXPECT_LT(share, (1 + kTilted) * share_of_a_far_board(wanted));
  }
}

}  // namespace
}  // namespace axial::calibrate
