// SPDX-License-Identifier: GPL-3.0-or-later
// Makes photographs of videos: chooses sharp frames with enough motion between them.

#include <nlohmann/json.hpp>
#include <set>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/log.h"
#include "base/program/program.h"
#include "base/same_file.h"
#include "base/version.h"
#include "io/bytes/json.h"
#include "video/extract_frames.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

struct Options {
  ParsedOptions parsed;
  std::vector<fs::path> clips;
  fs::path output, json;
  double motion = 0.1;
  int quality = 97;
  bool png = false;
};

void declare(OptionList& list, Options& options) {
  list.add("input-file,i", &options.clips, "video file; may be given several times")
      .add("output-folder,o", &options.output,
           "folder for the photographs; those of dive.mp4 go into its subfolder dive")
      .output_folder()
      .required("")
      .add("json", &options.json,
           "also write names, times, sharpness and motion of the frames to this file")
      .output_file()
      .add_with_default("motion", &options.motion,
                        "motion of the picture between chosen frames, as a share of its width")
      .sets("share")
      .add_with_default("jpeg-quality", &options.quality, "quality of the JPEG files, 1 to 100")
      .range(1, 100)
      .add_switch("png", &options.png, "write PNG files in place of JPEG files");
}

void check(const Options& options) {
  if (!(options.motion > 0 && options.motion <= 1))
    fail("--motion {}: must be above 0 and at most 1", options.motion);
  std::set<std::string> stems;
  for (const fs::path& clip : options.clips)
    if (!stems.insert(clip.stem().string()).second)
      fail_in(clip, "another clip has the name {}, too; rename one of them", clip.stem().string());
  if (!options.json.empty()) require_not_an_input(options.json, options.clips, "--json");
}

Options parse_command_line(int argc, const char* const* argv) {
  Options options;
  ProgramOptions program{
      "ExtractFrames",
      "makes photographs of videos: sharp frames with enough motion between them",
      {},
      {}};
  program.version = version_line(program.name);
  declare(program.visible, options);
  options.parsed = parse_options(argc, argv, program);
  if (!options.parsed.run) return options;
  check(options);
  return options;
}

fs::path folder_of(const fs::path& clip, const Options& options) {
  return options.output / clip.stem();
}

// Frames of an earlier run would be taken for frames of this one.
void require_no_frames(const fs::path& folder) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
    if (entry.path().filename().string().starts_with("frame_"))
      fail(
          "--output-folder: {} exists; remove the frames of the earlier run, or give another "
          "folder",
          entry.path().string());
}

void warn_of_rolling_shutter(const video::ChosenFrames& found) {
  const double pixels = video::median_pixels_per_frame(found);
  const double least = video::kLeastReadout * pixels;
  if (least > 1)
    log_warning(
        "{}: the picture moves by {:.1f} to {:.1f} pixels while a rolling shutter reads a frame "
        "(half of the time between frames, or all of it), which the programs do not model; move "
        "slower, or film with more frames per second",
        found.clip.string(), least, pixels);
}

video::ChosenFrames choose(const fs::path& clip, const Options& options, const Context& context) {
  video::ChosenFrames found = video::choose_in_clip(
      clip, options.motion, console_progress("Measured frames of " + clip.filename().string()),
      context);
  log_info("{}: {} of {} frames chosen, {} x {} pixels, {:.1f} s", clip.string(),
           found.chosen.size(), found.frames.size(), found.size.width, found.size.height,
           static_cast<double>(found.frames.size()) / found.frames_per_second);
  warn_of_rolling_shutter(found);
  return found;
}

int run(int argc, char** argv) {
  const Options options = parse_command_line(argc, argv);
  if (!options.parsed.run) return options.parsed.exit_code;
  const Context context = program_context(options.parsed);
  for (const fs::path& clip : options.clips) require_no_frames(folder_of(clip, options));
  require_writable_folder(options.output);
  if (!options.json.empty()) require_writable(options.json);
  nlohmann::json clips = nlohmann::json::array();
  std::vector<video::ChosenFrames> all;
  for (const fs::path& clip : options.clips) all.push_back(choose(clip, options, context));
  write_folder(options.output, [&](const fs::path& staging) {
    for (const video::ChosenFrames& found : all) {
      make_folder(staging / found.clip.stem());
      video::write_frames(found, staging / found.clip.stem(), options.png ? -1 : options.quality);
    }
  });
  for (const video::ChosenFrames& found : all)
    clips.push_back(video::frames_as_json(found, options.png ? ".png" : ".jpg"));
  if (!options.json.empty()) io::write_json(options.json, {{"clips", std::move(clips)}});
  log_info("Photographs in {}", options.output.string());
  return 0;
}

}  // namespace
}  // namespace axial::apps

int main(int argc, char** argv) {
  return axial::run_program("ExtractFrames", [&] { return axial::apps::run(argc, argv); });
}
