// SPDX-License-Identifier: GPL-3.0-or-later
#include "video/frame_motion.h"

#include <gmock/gmock.h>

#include "video/moving_texture.h"

namespace axial::video {
namespace {

// Corners are tracked to a tenth of a pixel, and many are averaged.
constexpr double kPixel = 1 / 320.0;

TEST(FrameMeter, MeasuresAShift) {
  const auto frames = test::moving_frames(3, 7.5);
  FrameMeter meter;
  EXPECT_FALSE(meter.measure(frames[0]).motion);
  const auto motion = meter.measure(frames[2]).motion;
  ASSERT_TRUE(motion);
  EXPECT_NEAR(motion->shift.real(), -15 * kPixel, 0.1 * kPixel);
  EXPECT_NEAR(motion->shift.imag(), 0, 0.1 * kPixel);
  EXPECT_NEAR(std::abs(motion->turn - 1.0), 0, 1e-3);
}

TEST(FrameMeter, MeasuresATurnAboutTheCentre) {
  const cv::Mat3b frame = test::moving_frames(1, 0)[0];
  cv::Mat3b turned;
  cv::warpAffine(frame, turned, cv::getRotationMatrix2D({159.5f, 119.5f}, -4, 1), frame.size());
  FrameMeter meter;
  meter.measure(frame);
  const auto motion = meter.measure(turned).motion;
  ASSERT_TRUE(motion);
  EXPECT_NEAR(std::arg(motion->turn) * 180 / CV_PI, 4, 0.1);
  EXPECT_NEAR(std::abs(motion->shift), 0, 0.3 * kPixel);
}

TEST(FrameMeter, ABlurredFrameIsLessSharp) {
  const auto frames = test::moving_frames(2, 1);
  FrameMeter meter;
  const double sharp = meter.measure(frames[0]).sharpness;
  EXPECT_LT(meter.measure(frames[1]).sharpness, 0.3 * sharp);
}

TEST(FrameMeter, ThereIsNoMotionWithoutCornersOrToAnotherScene) {
  FrameMeter meter;
  meter.measure(cv::Mat3b(240, 320, cv::Vec3b(90, 90, 90)));
  EXPECT_FALSE(meter.measure(cv::Mat3b(240, 320, cv::Vec3b(90, 90, 90))).motion);
  const cv::Mat3b frame = test::moving_frames(1, 0)[0];
  EXPECT_FALSE(meter.measure(frame).motion);
  cv::Mat3b other;
  cv::flip(frame, other, 0);
  EXPECT_FALSE(meter.measure(other).motion);
}

}  // namespace
}  // namespace axial::video
