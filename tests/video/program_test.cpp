// SPDX-License-Identifier: GPL-3.0-or-later
// ExtractFrames, with clips that OpenCV writes.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "io/bytes/json.h"
#include "io/images/image.h"
#include "support/program_run.h"
#include "video/moving_texture.h"

namespace axial::video {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class ExtractFrames : public test::ProgramTest {
 protected:
  void write(const std::string& name, const std::vector<cv::Mat3b>& frames) const {
    test::write_clip(folder_ / name, frames);
  }
  test::Outcome run(const std::string& arguments) const {
    return run_program("ExtractFrames", arguments);
  }
  void refuses(const std::string& arguments, const std::string& expected) const {
    const test::Outcome outcome = run(arguments + " -v 0");
    EXPECT_EQ(outcome.exit_code, 1) << outcome.output;
    EXPECT_THAT(outcome.output, HasSubstr(expected));
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
    EXPECT_FALSE(fs::exists(folder_ / "out"));
  }
};

// The picture moves by 6 of 320 pixels a frame, so that 24 to 40 pixels are 4 to 6 frames.
TEST_F(ExtractFrames, WritesSharpFramesWithTheStatedMotionBetweenThem) {
  const auto frames = test::moving_frames(60, 6);
  write("dive.avi", frames);
  const auto outcome = run("dive.avi -o out --json frames.json --png");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const auto clip = io::read_json(folder_ / "frames.json").at("clips").at(0);
  EXPECT_EQ(clip.at("frame_count"), 60);
  const auto& chosen = clip.at("frames");
  ASSERT_GE(chosen.size(), 9u);
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const auto frame = chosen[i].at("frame").get<std::size_t>();
    EXPECT_NE(frame % 3, 1u) << "is blurred";
    EXPECT_NEAR(chosen[i].at("seconds").get<double>(), static_cast<double>(frame) / 30, 1e-9);
    if (i > 0) {
      const auto step = frame - chosen[i - 1].at("frame").get<std::size_t>();
      EXPECT_GE(step, 4u);
      EXPECT_LE(step, 7u);
      EXPECT_NEAR(chosen[i].at("motion_px").get<double>(), 6, 0.2);
    }
    // The compression of the clip changes the pixels less than the motion of one frame does.
    const cv::Mat3b pixels = io::read_color_image(folder_ / "out" / "dive" / chosen[i].at("file"));
    const double changed = cv::norm(pixels, frames[frame], cv::NORM_L1);
    for (const std::size_t other : {frame + 1, frame > 0 ? frame - 1 : frame + 1})
      EXPECT_LT(changed, 0.3 * cv::norm(pixels, frames.at(other), cv::NORM_L1));
  }
}

TEST_F(ExtractFrames, FramesThatDependOnEarlierFramesAreRead) {
  const auto frames = test::moving_frames(60, 6);
  write("dive.mp4", frames);
  const auto outcome = run("dive.mp4 -o out --json frames.json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const auto clip = io::read_json(folder_ / "frames.json").at("clips").at(0);
  EXPECT_EQ(clip.at("frame_count"), 60);
  ASSERT_GE(clip.at("frames").size(), 9u);
  for (const auto& one : clip.at("frames")) {
    const auto frame = one.at("frame").get<std::size_t>();
    EXPECT_NE(frame % 3, 1u) << "is blurred";
    const cv::Mat3b pixels = io::read_color_image(folder_ / "out" / "dive" / one.at("file"));
    EXPECT_LT(cv::norm(pixels, frames[frame], cv::NORM_L1),
              0.5 * cv::norm(pixels, frames.at(frame + 1), cv::NORM_L1));
  }
}

TEST_F(ExtractFrames, TheSameClipGivesTheSameBytes) {
  write("dive.avi", test::moving_frames(40, 6));
  ASSERT_EQ(run("dive.avi -o a --json a.json --max-threads 1").exit_code, 0);
  ASSERT_EQ(run("dive.avi -o b --json b.json").exit_code, 0);
  EXPECT_EQ(read_file(folder_ / "a.json"), read_file(folder_ / "b.json"));
  for (const auto& entry : fs::directory_iterator(folder_ / "a" / "dive"))
    EXPECT_EQ(read_file(entry.path()), read_file(folder_ / "b" / "dive" / entry.path().filename()));
}

TEST_F(ExtractFrames, WarnsOfARollingShutterWhenThePictureMovesFast) {
  write("fast.avi", test::moving_frames(60, 6));
  EXPECT_THAT(run("fast.avi -o fast").output,
              HasSubstr("warning: " + (folder_ / "fast.avi").string() +
                        ": the picture moves by 3.0 to 6.0 pixels"));
  write("slow.avi", test::moving_frames(120, 1.5));
  const auto slow = run("slow.avi -o slow");
  EXPECT_EQ(slow.exit_code, 0) << slow.output;
  EXPECT_THAT(slow.output, Not(HasSubstr("warning")));
}

TEST_F(ExtractFrames, SeveralClipsGoIntoSubfolders) {
  write("a.avi", test::moving_frames(40, 6));
  write("b.avi", test::moving_frames(40, 6, {400, 240}));
  ASSERT_EQ(run("-i a.avi -i b.avi -o out").exit_code, 0);
  EXPECT_EQ(io::read_image_size(folder_ / "out" / "a" / "frame_000000.jpg"), cv::Size(320, 240));
  EXPECT_FALSE(fs::is_empty(folder_ / "out" / "b"));
  expect_refusal("ExtractFrames", "a.avi -o out", "frame_");
  fs::create_directory(folder_ / "more");
  write("more/a.avi", test::moving_frames(40, 6));
  expect_refusal("ExtractFrames", "-i a.avi -i more/a.avi -o new", "another clip has the name a");
}

TEST_F(ExtractFrames, UnusableClipsAreRefusedInOneLine) {
  refuses("no.avi -o out", "no.avi: not found");
  refuses(". -o out", ": is not a file");
  write_atomically(folder_ / "text.mp4", std::string(5000, 'x'));
  refuses("text.mp4 -o out", "text.mp4: is not a video that can be decoded");
  write_atomically(folder_ / "empty.mp4", std::string());
  refuses("empty.mp4 -o out", "empty.mp4: is not a video that can be decoded");
  write("rest.avi", test::moving_frames(30, 0));
  refuses("rest.avi -o out",
          "rest.avi: 1 of 30 frames can serve as photographs, at least 3 are needed: "
          "the picture does not move");
  write("short.avi", test::moving_frames(8, 6));
  refuses("short.avi -o out",
          "2 of 8 frames can serve as photographs, at least 3 are needed: the "
          "picture moves too little (--motion 0.1)");
  write("grey.avi", std::vector<cv::Mat3b>(20, cv::Mat3b(240, 320, cv::Vec3b(90, 90, 90))));
  refuses("grey.avi -o out", "0 of 20 frames");
}

TEST_F(ExtractFrames, AClipThatWasCutOffIsUsedWithAWarning) {
  write("dive.avi", test::moving_frames(80, 6));
  fs::resize_file(folder_ / "dive.avi", fs::file_size(folder_ / "dive.avi") * 6 / 10);
  const auto outcome = run("dive.avi -o out");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("of 80 frames; copy it again"));
}

TEST_F(ExtractFrames, WrongValuesAreRefused) {
  write("dive.avi", test::moving_frames(10, 6));
  refuses("dive.avi", "--output-folder is missing");
  refuses("dive.avi -o out --motion 0", "--motion 0: must be above 0 and at most 1");
  refuses("dive.avi -o out --motion nan", "--motion nan: must be above 0");
  refuses("dive.avi -o out --jpeg-quality 101", "--jpeg-quality 101: must be from 1 to 100");
  refuses("dive.avi -o out --json dive.avi", "--json");
}

}  // namespace
}  // namespace axial::video
