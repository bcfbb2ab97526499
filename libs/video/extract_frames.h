// SPDX-License-Identifier: GPL-3.0-or-later
// Makes photographs of a video: measures its frames, chooses some, and writes them.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <opencv2/core.hpp>
#include <vector>

#include "base/progress.h"
#include "video/choose_frames.h"

namespace axial::video {

// Fewer chosen frames are an error, because nothing can be reconstructed from them.
inline constexpr std::size_t kLeastFrames = 3;

// A rolling shutter reads the rows of a frame one after another, for this share of the time between
// two frames, at least. At most, it is the whole time.
inline constexpr double kLeastReadout = 0.5;

// A clip, and what was chosen in it.
struct ChosenFrames {
  std::filesystem::path clip;
  cv::Size size;  // [px]
  double frames_per_second = 0;
  std::vector<FrameMeasure> frames;  // all frames of the clip
  std::vector<std::size_t> chosen;   // numbers of frames, ascending, from 0
};

// Measures all frames of a clip and chooses some (choose_frames.h). Memory does not grow with the
// pixels of the clip. `share`: ChoiceRules::share; messages call it the setting "share". Error that
// names the clip if it cannot be read (clip.h), if frames have different sizes, or if fewer than
// kLeastFrames frames are chosen. Warns through `context` if the file ends before 0.9 times the
// frames that it states.
ChosenFrames choose_in_clip(const std::filesystem::path& clip, double share,
                            const ProgressSink& sink, const Context& context);

// How far the picture moves from the frame before to frame `i`, in pixels of the clip. 0 if the
// motion is not known.
double pixels_per_frame(const ChosenFrames& found, std::size_t i);

// The median of pixels_per_frame() over the chosen frames. 0 if no frame is chosen.
double median_pixels_per_frame(const ChosenFrames& found);

// The name of the photograph made of frame `i`: frame_000123.jpg, with this extension.
std::string frame_name(std::size_t i, const std::string& extension);

// Reads the clip again and writes the chosen frames into `folder`, which exists: as JPEG with this
// quality (0 to 100), or as PNG if the quality is negative. Error that names the file if a frame
// cannot be read or written.
void write_frames(const ChosenFrames& found, const std::filesystem::path& folder, int quality);

// The frames as JSON: name, number in the clip, time [s], sharpness, and motion [px] of each
// photograph.
nlohmann::json frames_as_json(const ChosenFrames& found, const std::string& extension);

}  // namespace axial::video
