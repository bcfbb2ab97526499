// SPDX-License-Identifier: GPL-3.0-or-later
// The rules of a table of options.
#include "base/program/option_values.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "base/log.h"
#include "support/error_of.h"

namespace axial {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

enum class Mode { slow, fast };

// The targets of a table with every rule.
struct Values {
  int views = 3;
  std::uint64_t samples = 10;
  double pixel = 0, error = 1, length = 0;
  std::optional<double> sigma;
  std::optional<bool> undistort;
  Mode mode = Mode::fast;
  std::string medium = "water", board;
  fs::path input, output, folder;
  std::vector<fs::path> clips;
};

ParsedOptions parse(Values& values, std::vector<const char*> arguments) {
  ProgramOptions program;
  program.name = "Test";
  program.visible.add_with_default("max-views", &values.views, "views")
      .range(1, 1000)
      .sets("views")
      .add_with_default("samples", &values.samples, "samples")
      .at_least(1)
      .add("pixel", &values.pixel, "width")
      .zero_or(0.5, 1e6)
      .add("gsd", &values.pixel, "the same as --pixel")
      .add("error", &values.error, "error")
      .positive()
      .add("length", &values.length, "length")
      .at_least(0)
      .add("sigma", &values.sigma, "sigma")
      .range(1e-9, 1e3)
      .add("undistort", &values.undistort, "bool without a default")
      .add_choice("mode", &values.mode, {{"slow", Mode::slow}, {"fast", Mode::fast}}, "mode")
      .sets("mode is slow", " slow")
      .add_with_default("medium", &values.medium, "medium")
      .one_of({"air", "water"})
      .add_text(
          "board", [&](const std::string& text) { values.board = "<" + text + ">"; }, "board")
      .add("scene", &values.input, "scene")
      .required("the scene")
      .add("output", &values.output, "output")
      .output_file()
      .add("folder", &values.folder, "folder")
      .output_folder()
      .add("clips", &values.clips, "clips")
      .add_not_built("cuda-device", "-1", {"-1", "-2"})
      .add_without_effect("step", 45.05, "accepted", "there are no steps")
      .add_without_effect("reduce-memory", true, "accepted", "there are no steps");
  arguments.insert(arguments.begin(), "Test");
  arguments.insert(arguments.end(), {"-w", "/tmp"});
  return parse_options(static_cast<int>(arguments.size()), arguments.data(), program);
}

TEST(OptionValues, AreWrittenToTheTargets) {
  Values values;
  parse(values, {"--scene",  "a b/../c.mvs", "--max-views", "7",       "--sigma",
                 "0.5",      "--undistort",  "0",           "--mode",  "slow",
                 "--medium", "air",          "--board",     "9x6",     "--output",
                 "x y.ply",  "--folder",     "out/",        "--clips", "1.mp4",
                 "--clips",  "/2.mp4",       "--pixel",     "0"});
  EXPECT_EQ(values.input, "/tmp/c.mvs");
  EXPECT_EQ(values.views, 7);
  EXPECT_EQ(values.sigma, 0.5);
  EXPECT_EQ(values.undistort, false);
  EXPECT_EQ(values.mode, Mode::slow);
  EXPECT_EQ(values.medium, "air");
  EXPECT_EQ(values.board, "<9x6>");
  EXPECT_EQ(values.output, "/tmp/x y.ply");
  EXPECT_EQ(values.folder, "/tmp/out/");
  EXPECT_EQ(values.clips, (std::vector<fs::path>{"/tmp/1.mp4", "/2.mp4"}));
}

TEST(OptionValues, StayAsTheyAreIfNoOptionIsGiven) {
  Values values;
  parse(values, {"--scene", "/a.mvs"});
  EXPECT_EQ(values.views, 3);
  EXPECT_EQ(values.sigma, std::nullopt);
  EXPECT_EQ(values.undistort, std::nullopt);
  EXPECT_EQ(values.mode, Mode::fast);
  EXPECT_EQ(values.board, "");
  EXPECT_EQ(values.output, "");
}

TEST(OptionValues, ThatBreakARuleAreRefused) {
  const auto refused = [](std::vector<const char*> arguments) {
    Values values;
    arguments.insert(arguments.end(), {"--scene", "/a.mvs"});
    return test::error_of([&] { parse(values, arguments); });
  };
  EXPECT_EQ(refused({"--max-views", "0"}), "--max-views 0: must be from 1 to 1000");
  EXPECT_EQ(refused({"--max-views", "1001"}), "--max-views 1001: must be from 1 to 1000");
  EXPECT_EQ(refused({"--samples", "0"}), "--samples 0: must be at least 1");
  EXPECT_EQ(refused({"--pixel", "0.1"}), "--pixel 0.1: must be from 0.5 to 1000000, or 0");
  EXPECT_EQ(refused({"--gsd", "-1"}), "--pixel -1: must be from 0.5 to 1000000, or 0");
  EXPECT_EQ(refused({"--error", "0"}), "--error 0: must be positive");
  EXPECT_EQ(refused({"--error", "inf"}), "--error inf: must be positive");
  EXPECT_EQ(refused({"--length", "nan"}), "--length nan: must be finite, and at least 0");
  EXPECT_EQ(refused({"--length", "inf"}), "--length inf: must be finite, and at least 0");
  EXPECT_EQ(refused({"--sigma", "0"}), "--sigma 0: must be from 1e-09 to 1000");
  EXPECT_EQ(refused({"--mode", "FAST"}), "--mode FAST: must be one of slow, fast");
  EXPECT_EQ(refused({"--medium", "oil"}), "--medium oil: must be one of air, water");
  EXPECT_EQ(refused({"--cuda-device", "0"}), "--cuda-device 0: not built yet");
  EXPECT_EQ(refused({"--output", "new/"}),
            "--output new/: must be the name of a file, not of a folder");
  EXPECT_THAT(refused({"--folder", "a\nb"}), HasSubstr("--folder a"));
  Values values;
  EXPECT_EQ(test::error_of([&] { parse(values, {}); }), "--scene is missing: the scene");
  EXPECT_EQ(test::error_of([&] {
              parse(values, {"--scene", ""});
            }),
            "--scene is missing: the scene");
}

TEST(OptionValues, OptionsWithoutEffectAreNamedInOneWarning) {
  Values values;
  const LogLevel level = log_level();
  testing::internal::CaptureStdout();
  start_log("Test", "");
  const ParsedOptions parsed =
      parse(values, {"--scene", "/a.mvs", "--step", "2", "--reduce-memory", "0"});
  warn_without_effect(parsed, {"step", "pixel", "scene"}, "here");
  warn_without_effect(parsed, {"pixel"}, "here");
  const std::string said = testing::internal::GetCapturedStdout();
  set_log_level(level);
  EXPECT_THAT(said, HasSubstr("--step, --reduce-memory: without effect: there are no steps\n"));
  EXPECT_THAT(said, HasSubstr("--step, --scene: without effect here\n"));
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 2);
}

TEST(OptionValues, SettingsAreNamedByTheirOptions) {
  Values values;
  const LogCapture log;
  parse(values, {"--scene", "/a.mvs"});
  EXPECT_EQ(log_words(setting("max_views")), "--max-views");
  EXPECT_EQ(log_words(setting("views")), "--max-views");
  EXPECT_EQ(log_words(setting("mode is slow")), "--mode slow");
  EXPECT_EQ(log_words(setting("working_folder")), "--working-folder");
  EXPECT_EQ(log_words(setting("no_option")), "no_option");
}

}  // namespace
}  // namespace axial
