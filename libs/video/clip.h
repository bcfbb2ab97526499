// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the frames of a video file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

namespace axial::video {

// A video file, read from its first frame on. Pixels keep the order in which they are stored: a tag
// that turns the picture is ignored, because the lens belongs to the stored picture.
class Clip {
 public:
  // Error that names `path` if it is no file, no video that can be decoded, or states no frame
  // rate.
  explicit Clip(const std::filesystem::path& path);

  // Goes on to the next frame. False at the end of the clip, and where the file is damaged.
  bool next();
  // The present frame, B G R with 8 bits. Error that names the file if it cannot be decoded.
  cv::Mat3b frame();

  double frames_per_second() const { return per_second_; }
  // The number of frames that the file states; 0 if it states none. The file may hold fewer.
  std::size_t stated_count() const { return stated_count_; }

 private:
  std::filesystem::path path_;
  cv::VideoCapture capture_;
  double per_second_ = 0;
  std::size_t stated_count_ = 0;
};

}  // namespace axial::video
