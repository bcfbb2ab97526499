// SPDX-License-Identifier: GPL-3.0-or-later
#include "video/frame_motion.h"

#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <vector>

namespace axial::video {
namespace {

constexpr int kSide = 960;                 // of the grey copy [px]
constexpr int kCorners = 200;              // tracked, at most
constexpr double kQuality = 0.01;          // of a corner, beside the best corner of the frame
constexpr double kBetweenCorners = 0.015;  // widths of the picture
constexpr double kAgreement = 0.005;       // of a corner with the motion, widths of the picture
constexpr int kLeastCorners = 12;
constexpr double kLeastShare = 0.4;  // of the corners that agree

cv::Mat1b small_grey(const cv::Mat3b& frame) {
  cv::Mat1b grey, small;
  cv::cvtColor(frame, grey, cv::COLOR_BGR2GRAY);
  const double factor = static_cast<double>(kSide) / std::max(grey.cols, grey.rows);
  if (factor >= 1) return grey;
  cv::resize(grey, small, {}, factor, factor, cv::INTER_AREA);
  return small;
}

double sharpness_of(const cv::Mat1b& grey) {
  cv::Mat1f laplacian;
  cv::Scalar mean, deviation;
  cv::Laplacian(grey, laplacian, CV_32F);
  cv::meanStdDev(laplacian, mean, deviation);
  return deviation[0] * deviation[0];
}

// Corners of the frame `before` and their places in the frame `now`.
struct Tracks {
  std::vector<cv::Point2f> before, now;
};

Tracks track(const cv::Mat1b& before, const cv::Mat1b& now) {
  std::vector<cv::Point2f> corners, moved;
  cv::goodFeaturesToTrack(before, corners, kCorners, kQuality, kBetweenCorners * before.cols);
  Tracks tracks;
  if (corners.empty()) return tracks;
  std::vector<unsigned char> found;
  cv::calcOpticalFlowPyrLK(before, now, corners, moved, found, cv::noArray(), {21, 21}, 4);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (!found[i]) continue;
    tracks.before.push_back(corners[i]);
    tracks.now.push_back(moved[i]);
  }
  return tracks;
}

// `similarity`: [a -b x; b a y] of pixels. The point p has the place z = (p - centre) / width.
Motion in_widths(const cv::Matx23d& similarity, cv::Size size) {
  const std::complex<double> turn(similarity(0, 0), similarity(1, 0));
  const std::complex<double> shift(similarity(0, 2), similarity(1, 2));
  const std::complex<double> centre((size.width - 1) / 2.0, (size.height - 1) / 2.0);
  const double width = size.width;
  return {turn, (turn * centre + shift - centre) / width};
}

std::optional<Motion> motion_between(const cv::Mat1b& before, const cv::Mat1b& now) {
  if (before.size() != now.size()) return std::nullopt;
  const Tracks tracks = track(before, now);
  if (tracks.now.size() < kLeastCorners) return std::nullopt;
  std::vector<unsigned char> agrees;
  const cv::Mat found = cv::estimateAffinePartial2D(tracks.before, tracks.now, agrees, cv::RANSAC,
                                                    kAgreement * now.cols);
  const int count = cv::countNonZero(agrees);
  if (found.empty() || count < kLeastCorners ||
      count < kLeastShare * static_cast<double>(tracks.now.size()))
    return std::nullopt;
  return in_widths(cv::Matx23d(found), now.size());
}

}  // namespace

FrameMeasure FrameMeter::measure(const cv::Mat3b& frame) {
  cv::Mat1b now = small_grey(frame);
  FrameMeasure measure{sharpness_of(now), std::nullopt};
  if (!before_.empty()) measure.motion = motion_between(before_, now);
  before_ = std::move(now);
  return measure;
}

}  // namespace axial::video
