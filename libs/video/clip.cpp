// SPDX-License-Identifier: GPL-3.0-or-later
#include "video/clip.h"

#include <cmath>
#include <cstdlib>
#include <opencv2/core/utils/logger.hpp>

#include "base/error.h"

namespace axial::video {
namespace {

constexpr double kMostPerSecond = 10000, kMostFrames = 1e8;  // larger numbers are damage

// OpenCV and FFmpeg print messages of their own, which would appear before ours.
void silence_libraries() {
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0);
}

}  // namespace

Clip::Clip(const std::filesystem::path& path) : path_(path) {
  if (!std::filesystem::exists(path)) fail_in(path, "not found");
  if (!std::filesystem::is_regular_file(path)) fail_in(path, "is not a file");
  silence_libraries();
  if (!capture_.open(path.string(), cv::CAP_FFMPEG))
    fail_in(path, "is not a video that can be decoded");
  capture_.set(cv::CAP_PROP_ORIENTATION_AUTO, 0);
  per_second_ = capture_.get(cv::CAP_PROP_FPS);
  if (!(per_second_ > 0 && per_second_ < kMostPerSecond))
    fail_in(path, "states a frame rate of {} Hz", per_second_);
  const double count = capture_.get(cv::CAP_PROP_FRAME_COUNT);
  if (count > 0 && count < kMostFrames) stated_count_ = static_cast<std::size_t>(count);
}

bool Clip::next() {
  return capture_.grab();
}

cv::Mat3b Clip::frame() {
  cv::Mat pixels;
  if (!capture_.retrieve(pixels) || pixels.type() != CV_8UC3)
    fail_in(path_, "a frame cannot be decoded");
  return pixels;
}

}  // namespace axial::video
