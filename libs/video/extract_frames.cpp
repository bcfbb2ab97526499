// SPDX-License-Identifier: GPL-3.0-or-later
#include "video/extract_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/order_statistics.h"
#include "io/images/image.h"
#include "video/clip.h"
#include "video/frame_motion.h"

namespace axial::video {
namespace fs = std::filesystem;

namespace {

constexpr double kWholeClip =
    0.9;  // of the frames that a file states; many files state an estimate

double aspect_of(cv::Size size) {
  return static_cast<double>(size.height) / size.width;
}

void measure_frames(Clip& clip, ChosenFrames& found, const ProgressSink& sink) {
  FrameMeter meter;
  while (clip.next()) {
    const cv::Mat3b frame = clip.frame();
    if (found.frames.empty()) found.size = frame.size();
    if (frame.size() != found.size)
      fail_in(found.clip, "frame {} has {} x {} pixels, but the first one has {} x {}",
              found.frames.size(), frame.cols, frame.rows, found.size.width, found.size.height);
    found.frames.push_back(meter.measure(frame));
    if (sink && found.frames.size() < clip.stated_count())
      sink(found.frames.size(), clip.stated_count());
  }
  if (sink) sink(found.frames.size(), found.frames.size());
}

void check_count(const ChosenFrames& found, double share) {
  if (found.chosen.size() >= kLeastFrames) return;
  const bool moves = found.chosen.size() > 1;
  fail_in(found.clip,
          "{} of {} frames can serve as photographs, at least {} are needed: {} ({} {})",
          found.chosen.size(), found.frames.size(), kLeastFrames,
          moves ? "the picture moves too little"
                : "the picture does not move, or nothing in it can be tracked",
          setting("share"), share);
}

}  // namespace

ChosenFrames choose_in_clip(const fs::path& path, double share, const ProgressSink& sink,
                            const Context& context) {
  Clip clip(path);
  ChosenFrames found{path, {}, clip.frames_per_second(), {}, {}};
  measure_frames(clip, found, sink);
  if (found.frames.empty()) fail_in(path, "no frame can be decoded");
  if (static_cast<double>(found.frames.size()) <
      kWholeClip * static_cast<double>(clip.stated_count()))
    context.warning("{}: ends after {} of {} frames; copy it again", path.string(),
                    found.frames.size(), clip.stated_count());
  found.chosen =
      choose_frames(found.frames, {share, found.frames_per_second, aspect_of(found.size)});
  check_count(found, share);
  return found;
}

double pixels_per_frame(const ChosenFrames& found, std::size_t i) {
  const std::optional<Motion>& motion = found.frames[i].motion;
  return motion ? displacement(*motion, aspect_of(found.size)) * found.size.width : 0;
}

double median_pixels_per_frame(const ChosenFrames& found) {
  std::vector<double> pixels;
  for (const std::size_t i : found.chosen) pixels.push_back(pixels_per_frame(found, i));
  return upper_median(std::move(pixels));
}

std::string frame_name(std::size_t i, const std::string& extension) {
  return fmt::format("frame_{:06}{}", i, extension);
}

void write_frames(const ChosenFrames& found, const fs::path& folder, int quality) {
  Clip clip(found.clip);
  std::size_t at = 0;  // the number of frames read
  for (const std::size_t i : found.chosen) {
    while (at <= i) {
      if (!clip.next()) fail_in(found.clip, "frame {} cannot be read again", at);
      ++at;
    }
    if (quality < 0)
      io::write_png(folder / frame_name(i, ".png"), clip.frame());
    else
      io::write_jpeg(folder / frame_name(i, ".jpg"), clip.frame(), quality);
  }
}

nlohmann::json frames_as_json(const ChosenFrames& found, const std::string& extension) {
  nlohmann::json frames = nlohmann::json::array();
  for (const std::size_t i : found.chosen)
    frames.push_back({{"file", frame_name(i, extension)},
                      {"frame", i},
                      {"seconds", static_cast<double>(i) / found.frames_per_second},
                      {"sharpness", found.frames[i].sharpness},
                      {"motion_px", pixels_per_frame(found, i)}});
  return {{"clip", found.clip.filename().string()},
          {"width", found.size.width},
          {"height", found.size.height},
          {"frames_per_second", found.frames_per_second},
          {"frame_count", found.frames.size()},
          {"frames", std::move(frames)}};
}

}  // namespace axial::video
