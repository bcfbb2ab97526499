// SPDX-License-Identifier: GPL-3.0-or-later
#include "video/choose_frames.h"

#include <gmock/gmock.h>

#include <numbers>

namespace axial::video {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr ChoiceRules kRules{0.1, 30, 0.75};

// `count` frames of the same sharpness that move to the right by `step` widths each.
std::vector<FrameMeasure> steady(std::size_t count, double step) {
  std::vector<FrameMeasure> frames(count, {1, Motion{1, step}});
  frames.front().motion.reset();
  return frames;
}

// The motion from frame `a` to frame `b`, in widths.
double moved(const std::vector<FrameMeasure>& frames, std::size_t a, std::size_t b) {
  Motion motion;
  for (std::size_t i = a + 1; i <= b; ++i) motion = then(motion, *frames[i].motion);
  return displacement(motion, kRules.aspect);
}

TEST(Motion, AShiftMovesEveryPointByItsLength) {
  EXPECT_NEAR(displacement({1, {0.03, 0.04}}, 0.75), 0.05, 1e-15);
  EXPECT_EQ(displacement({}, 0.75), 0);
}

// The mean of |z|^2 over a grid of points, against the formula.
TEST(Motion, TheDisplacementOfATurnAndAZoomIsThatOfAGridOfPoints) {
  const Motion motion{std::polar(1.1, 0.2), {0.01, -0.02}};
  double sum = 0;
  constexpr int kSide = 400;
  for (int i = 0; i < kSide; ++i)
    for (int k = 0; k < kSide; ++k) {
      const std::complex<double> z((i + 0.5) / kSide - 0.5, 0.75 * ((k + 0.5) / kSide - 0.5));
      sum += std::norm(motion.turn * z + motion.shift - z);
    }
  // The grid's mean square is off by 1 / kSide^2 of its value.
  EXPECT_NEAR(displacement(motion, 0.75), std::sqrt(sum / (kSide * kSide)), 1e-6);
}

TEST(Motion, MotionsFollowEachOther) {
  const Motion first{std::polar(1.1, 0.2), {0.01, -0.02}}, second{std::polar(0.9, 0.1), {0.3, 0}};
  const std::complex<double> z(0.2, 0.1);
  const Motion both = then(first, second);
  EXPECT_NEAR(std::abs(both.turn * z + both.shift -
                       (second.turn * (first.turn * z + first.shift) + second.shift)),
              0, 1e-15);
}

TEST(ChooseFrames, SteadyMotionGivesFramesAtThreeQuartersOfTheShareOrMore) {
  const auto frames = steady(100, 0.01);
  const auto chosen = choose_frames(frames, kRules);
  ASSERT_GE(chosen.size(), 8u);
  EXPECT_EQ(chosen.front(), 0u);
  for (std::size_t i = 1; i < chosen.size(); ++i) {
    EXPECT_GE(moved(frames, chosen[i - 1], chosen[i]), 0.075 - 1e-12);
    EXPECT_LE(moved(frames, chosen[i - 1], chosen[i]), 0.125 + 1e-12);
  }
}

TEST(ChooseFrames, ASharpFrameInTheRangeIsChosenAndBlurredOnesAreNot) {
  auto frames = steady(56, 0.01);
  for (auto& frame : frames) frame.sharpness = 0.2;
  for (std::size_t i = 0; i < frames.size(); i += 10) frames[i].sharpness = 1;
  EXPECT_THAT(choose_frames(frames, kRules), ElementsAre(0, 10, 20, 30, 40, 50));
}

// A sandy place in the clip has less contrast than a reef: sharpness counts beside the neighbours.
TEST(ChooseFrames, SharpnessIsThatBesideTheNeighbours) {
  auto frames = steady(15, 0.01);
  for (std::size_t i = 0; i < frames.size(); ++i)
    frames[i].sharpness = std::exp(-0.3 * static_cast<double>(i));
  frames[10].sharpness *= 1.5;
  ASSERT_LT(frames[10].sharpness, frames[8].sharpness);
  EXPECT_THAT(choose_frames(frames, {0.1, 8, 0.75}), ElementsAre(0, 10));
}

TEST(ChooseFrames, AVideoThatRestsGivesOneFrame) {
  EXPECT_THAT(choose_frames(steady(100, 0), kRules), ElementsAre(0));
}

TEST(ChooseFrames, DoubledFramesAreNotChosenTwice) {
  auto frames = steady(40, 0.01);
  for (std::size_t i = 1; i < frames.size(); i += 2) frames[i].motion = Motion{};
  const auto chosen = choose_frames(frames, kRules);
  ASSERT_GE(chosen.size(), 2u);
  for (std::size_t i = 1; i < chosen.size(); ++i)
    EXPECT_GE(moved(frames, chosen[i - 1], chosen[i]), 0.075 - 1e-12);
}

TEST(ChooseFrames, MotionBackAndForthDoesNotAddUp) {
  auto frames = steady(400, 0);
  for (std::size_t i = 1; i < frames.size(); ++i)
    frames[i].motion->shift = i % 4 < 2 ? 0.01 : -0.01;
  EXPECT_THAT(choose_frames(frames, kRules), ElementsAre(0));
}

TEST(ChooseFrames, TurningAboutTheAxisAndGoingForwardsAreMotion) {
  auto turning = steady(100, 0), forwards = turning;
  for (std::size_t i = 1; i < turning.size(); ++i) {
    turning[i].motion->turn = std::polar(1.0, std::numbers::pi / 180);
    forwards[i].motion->turn = 1.01;
  }
  EXPECT_GT(choose_frames(turning, kRules).size(), 3u);
  EXPECT_GT(choose_frames(forwards, kRules).size(), 3u);
}

TEST(ChooseFrames, AfterALeapTheNextFrameIsChosen) {
  auto frames = steady(6, 0);
  frames[3].motion = Motion{1, 0.5};
  EXPECT_THAT(choose_frames(frames, kRules), ElementsAre(0, 3));
}

TEST(ChooseFrames, AfterACutFramesAreChosenAnew) {
  auto frames = steady(8, 0.001);
  frames[4].motion.reset();
  EXPECT_THAT(choose_frames(frames, kRules), ElementsAre(0, 4));
}

TEST(ChooseFrames, FramesWithoutAnyMotionKnownAreNotChosen) {
  EXPECT_THAT(choose_frames({}, kRules), IsEmpty());
  EXPECT_THAT(choose_frames(std::vector<FrameMeasure>(20, {1, std::nullopt}), kRules), IsEmpty());
}

}  // namespace
}  // namespace axial::video
