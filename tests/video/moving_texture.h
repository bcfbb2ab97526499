// SPDX-License-Identifier: GPL-3.0-or-later
// A grey picture of random blobs, and views of it that move.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <vector>

namespace axial::test {

inline cv::Mat3b random_texture(cv::Size size) {
  cv::RNG random(7);
  cv::Mat1b coarse(size / 6), grey;
  cv::Mat3b texture;
  random.fill(coarse, cv::RNG::UNIFORM, 0, 256);
  cv::resize(coarse, grey, size, 0, 0, cv::INTER_CUBIC);
  cv::cvtColor(grey, texture, cv::COLOR_GRAY2BGR);
  return texture;
}

// The part of `texture` of this size that begins at the column `left` [px], which may be a
// fraction.
inline cv::Mat3b view_of(const cv::Mat3b& texture, double left, cv::Size size) {
  const cv::Matx23d shift(1, 0, -left, 0, 1, -20);
  cv::Mat3b view;
  cv::warpAffine(texture, view, shift, size, cv::INTER_LINEAR);
  return view;
}

// Writes frames as a video with 30 frames per second: an .avi of Motion JPEG, or an .mp4 of MPEG-4,
// whose frames depend on earlier frames.
inline void write_clip(const std::filesystem::path& file, const std::vector<cv::Mat3b>& frames) {
  const bool mp4 = file.extension() == ".mp4";
  const int codec = mp4 ? cv::VideoWriter::fourcc('m', 'p', '4', 'v')
                        : cv::VideoWriter::fourcc('M', 'J', 'P', 'G');
  cv::VideoWriter writer(file.string(), mp4 ? cv::CAP_FFMPEG : cv::CAP_OPENCV_MJPEG, codec, 30,
                         frames.front().size());
  for (const cv::Mat3b& frame : frames) writer.write(frame);
}

// Views of a texture that moves to the left by `step` pixels a frame. Every third frame is blurred.
inline std::vector<cv::Mat3b> moving_frames(std::size_t count, double step,
                                            cv::Size size = {320, 240}) {
  const cv::Mat3b texture = random_texture({1600, 320});
  std::vector<cv::Mat3b> frames;
  for (std::size_t i = 0; i < count; ++i) {
    cv::Mat3b frame = view_of(texture, step * static_cast<double>(i), size);
    if (i % 3 == 1) cv::GaussianBlur(frame, frame, {}, 3);
    frames.push_back(frame);
  }
  return frames;
}

}  // namespace axial::test
