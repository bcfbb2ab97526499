// SPDX-License-Identifier: GPL-3.0-or-later
// A run of fake stages that is stopped at every place, and continued.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"
#include "densify/map_stages.h"
#include "support/empty_folder.h"
#include "support/error_of.h"

namespace axial::densify {
namespace {

namespace fs = std::filesystem;

// A map of 4 x 3 pixels, all with the same depth [m].
DepthMap flat_map(std::size_t image, float depth) {
  DepthMap map;
  map.image_path = "image" + std::to_string(image);
  map.ids = {static_cast<std::uint32_t>(image)};
  map.camera.width = 4;
  map.camera.height = 3;
  map.camera.lens = {3, 3, 1, 1};
  map.min_depth = 0.5f;
  map.max_depth = 100;
  map.depth = cv::Mat1f(3, 4, depth);
  map.normal = cv::Mat3f(3, 4, cv::Vec3f(0, 0, -1));
  map.confidence = cv::Mat1f(3, 4, 0.5f);
  return map;
}

// The ray of this pixel is the optical axis, on which files keep depths exactly.
float depth_of(const DepthMap& map) {
  return map.depth(1, 1);
}

// A call of Stage::make: the stage's name and the image.
using Call = std::pair<std::string, std::size_t>;

// Three stages, and the images 0, 2 and 3. The depths of a stage are computed from those of the
// previous stage, so that a wrong file of the previous stage changes the result.
class Resume : public testing::Test {
 protected:
  void run(const std::string& fingerprint = "print", std::size_t most_stages = 3) {
    calls_.clear();
    checks_.clear();
    const auto existing = statuses(images_);
    StageRun run = run_of(images_, existing, fingerprint);
    run.most_stages = most_stages;
    run.check = [&](bool first_stage, const ReadMap& read_map) {
      checks_.emplace_back(first_stage, depth_of(read_map(3)));
    };
    run_stages(stages(), run);
  }

  void run_part(std::size_t stage, const std::vector<std::size_t>& images,
                const std::string& fingerprint = "print") {
    calls_.clear();
    const auto existing = statuses(images);
    axial::densify::run_part(stages(), stage, run_of(images, existing, fingerprint));
  }

  std::vector<io::DmapStatus> statuses(const std::vector<std::size_t>& images) const {
    std::vector<io::DmapStatus> existing(4);
    for (const std::size_t image : images) existing[image] = io::dmap_status(final_file(image));
    return existing;
  }

  StageRun run_of(const std::vector<std::size_t>& images,
                  const std::vector<io::DmapStatus>& existing, const std::string& fingerprint) {
    StageRun run;
    run.images = images;
    run.all_images = images_;
    run.final_file = [&](std::size_t image) { return final_file(image); };
    run.fingerprint = fingerprint;
    run.existing = existing;
    run.cached_depths = run.cached_maps = 2;
    return run;
  }

  // Runs until `place` and throws the call away there.
  void run_until(const Call& place) {
    stop_at_ = place;
    EXPECT_EQ(test::error_of([&] { run(); }), "stopped");
    stop_at_ = {};
  }

  // A stage whose maps have the depth that `depth` returns.
  Stage stage(const std::string& name,
              std::function<float(std::size_t image, PreviousMaps& previous)> depth,
              bool whole_maps = false) {
    const auto make = [this, name, depth](std::size_t image, PreviousMaps& previous) {
      if (stop_at_ == Call(name, image)) fail("stopped");
      calls_.emplace_back(name, image);
      return flat_map(image, depth(image, previous));
    };
    const auto needs = [](std::size_t image) { return std::vector<std::size_t>{image, 0, 3}; };
    return {name, "Stage " + name, make, whole_maps, needs};
  }

  std::vector<Stage> stages() {
    return {stage("first", [](std::size_t image,
                              PreviousMaps&) { return 1.0f + static_cast<float>(image); }),
            stage("second",
                  [](std::size_t image, PreviousMaps& previous) {
                    return depth_of(previous.read(image)) + 2 * depth_of(*previous.get(3));
                  }),
            stage(
                "third",
                [](std::size_t image, PreviousMaps& previous) {
                  return depth_of(*previous.get(image)) + depth_of(*previous.get(0));
                },
                true)};
  }

  fs::path final_file(std::size_t image) const {
    return folder_ / ("map" + std::to_string(image) + ".dmap");
  }

  fs::path file_of(const std::string& stage, std::size_t image) const {
    return folder_ / ("map" + std::to_string(image) + "." + stage + ".dmap");
  }

  // The names and contents of all files in the folder.
  std::map<std::string, std::string> files() const {
    std::map<std::string, std::string> found;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_))
      found[entry.path().filename().string()] = read_file(entry.path());
    return found;
  }

  // The files that a run leaves.
  std::map<std::string, std::string> files_of_a_run() {
    run();
    return files();
  }

  // Removes the files, so that the next run begins with nothing.
  void remove_files() const {
    for (const auto& [name, content] : files()) fs::remove(folder_ / name);
  }

  // All calls of a run that begins with nothing, from `place` on.
  std::vector<Call> calls_from(const Call& place) const {
    std::vector<Call> all;
    for (const char* name : {"first", "second", "third"})
      for (const std::size_t image : images_) all.emplace_back(name, image);
    return {std::ranges::find(all, place), all.end()};
  }

  const fs::path folder_ = test::empty_folder();
  const std::vector<std::size_t> images_{0, 2, 3};
  Call stop_at_;
  std::vector<Call> calls_;
  std::vector<std::pair<bool, float>> checks_;  // first_stage, depth of image 3
};

TEST_F(Resume, ARunMakesEveryMapOnceAndLeavesTheFinalMaps) {
  run();
  EXPECT_EQ(calls_, calls_from({"first", 0}));
  std::vector<std::string> names;
  for (const auto& [name, content] : files()) names.push_back(name);
  EXPECT_THAT(names, testing::ElementsAre("map0.dmap", "map0.dmap.json", "map2.dmap",
                                          "map2.dmap.json", "map3.dmap", "map3.dmap.json"));
  // first: 1, 3, 4; second: that and 2 * 4; third: that and 9.
  EXPECT_EQ(depth_of(io::read_dmap(final_file(0)).map), 18);
  EXPECT_EQ(depth_of(io::read_dmap(final_file(2)).map), 20);
  EXPECT_EQ(depth_of(io::read_dmap(final_file(3)).map), 21);
}

TEST_F(Resume, AStoppedRunMakesExactlyTheMissingMapsAndTheSameBytes) {
  const auto expected = files_of_a_run();
  for (const Call& place : calls_from({"first", 0})) {
    remove_files();
    run_until(place);
    run();
    EXPECT_EQ(calls_, calls_from(place)) << place.first << place.second;
    EXPECT_EQ(files(), expected) << place.first << place.second;
  }
}

TEST_F(Resume, ACompleteRunMakesNothing) {
  const auto expected = files_of_a_run();
  run();
  EXPECT_TRUE(calls_.empty());
  EXPECT_EQ(files(), expected);
}

TEST_F(Resume, ARunOfOtherInputMakesEverythingAgain) {
  run();
  run("other");
  EXPECT_EQ(calls_, calls_from({"first", 0}));
  EXPECT_EQ(io::read_dmap(final_file(0)).made_from, "other third");
  run_until({"third", 2});
  run("other again");
  EXPECT_EQ(calls_, calls_from({"first", 0}));
}

// Each way to spoil the file of one map.
struct Spoiled {
  std::string what;
  std::function<void(const fs::path& file)> spoil;
};

std::vector<Spoiled> ways_to_spoil(const std::string& stage) {
  const auto written = [](const std::string& made_from) {
    return [made_from](const fs::path& file) { io::write_dmap(file, flat_map(2, 70), made_from); };
  };
  return {{"other fingerprint", written("other " + stage)},
          {"other stage", written("print first")},
          {"truncated", [](const fs::path& file) { fs::resize_file(file, 40); }},
          {"of another program", [](const fs::path& file) { fs::remove(file.string() + ".json"); }},
          {"without the map", [](const fs::path& file) { fs::remove(file); }},
          {"damaged side file",
           [](const fs::path& file) { fs::resize_file(file.string() + ".json", 10); }}};
}

// The files of the first stage are gone when the second is complete, so they are made again first.
TEST_F(Resume, ASpoiledMapOfAStageIsMadeAgain) {
  const auto expected = files_of_a_run();
  for (const Spoiled& way : ways_to_spoil("second")) {
    remove_files();
    run_until({"third", 0});
    ASSERT_TRUE(fs::exists(file_of("second", 2)));
    ASSERT_FALSE(fs::exists(file_of("first", 2)));
    way.spoil(file_of("second", 2));
    run();
    EXPECT_EQ(calls_, (std::vector<Call>{{"first", 0},
                                         {"first", 2},
                                         {"first", 3},
                                         {"second", 2},
                                         {"third", 0},
                                         {"third", 2},
                                         {"third", 3}}))
        << way.what;
    EXPECT_EQ(files(), expected) << way.what;
  }
}

TEST_F(Resume, ASpoiledFinalMapIsMadeAgain) {
  const auto expected = files_of_a_run();
  for (const Spoiled& way : ways_to_spoil("third")) {
    way.spoil(final_file(2));
    run();
    std::vector<Call> made = calls_from({"first", 0});
    std::erase(made, Call("third", 0));
    std::erase(made, Call("third", 3));
    EXPECT_EQ(calls_, made) << way.what;
    EXPECT_EQ(files(), expected) << way.what;
  }
}

TEST_F(Resume, TheMapsOfTheFirstStageOrTheLatestCompleteOnesAreCheckedOnce) {
  using Checks = std::vector<std::pair<bool, float>>;
  const auto expect_checks = [&](const Checks& expected) {
    run();
    EXPECT_EQ(checks_, expected);
  };
  expect_checks({{true, 4}});
  expect_checks({{false, 21}});
  remove_files();
  run_until({"second", 2});
  expect_checks({{true, 4}});
  remove_files();
  run_until({"third", 2});
  expect_checks({{false, 12}});
}

TEST_F(Resume, PartsInAnyOrderGiveTheBytesOfOneRun) {
  const auto expected = files_of_a_run();
  const std::vector<std::size_t> parts[] = {{0}, {2, 3}};
  for (const bool reversed : {false, true}) {
    remove_files();
    for (std::size_t stage = 0; stage < 3; ++stage)
      for (const bool second : {reversed, !reversed}) {
        run_part(stage, parts[second ? 1 : 0]);
        EXPECT_EQ(calls_.size(), second ? 2u : 1u);
      }
    EXPECT_TRUE(fs::exists(file_of("first", 0)));
    run();  // removes the files of the stages before the last
    EXPECT_TRUE(calls_.empty());
    EXPECT_EQ(files(), expected);
  }
}

TEST_F(Resume, APartMakesNothingIfALaterStageIsComplete) {
  const auto expected = files_of_a_run();
  for (std::size_t stage = 0; stage < 3; ++stage) {
    run_part(stage, {0});
    EXPECT_TRUE(calls_.empty()) << stage;
  }
  EXPECT_EQ(files(), expected);
  fs::remove(final_file(3));
  run_part(0, {0});
  EXPECT_EQ(calls_, (std::vector<Call>{{"first", 0}}));
}

TEST_F(Resume, APartNeedsTheMapsOfThePreviousStage) {
  run_part(0, {0, 2});
  EXPECT_EQ(test::error_of([&] { run_part(1, {0}); }),
            file_of("first", 3).string() +
                ": is missing, or was made from other input or settings: first make the stage "
                "first of all parts");
  run_part(0, {3});
  EXPECT_THAT(test::error_of([&] { run_part(1, {0}, "other"); }),
              testing::HasSubstr("other input"));
  run_part(1, {0});
  EXPECT_EQ(calls_, (std::vector<Call>{{"second", 0}}));
  run_part(1, {0, 3});
  EXPECT_EQ(calls_, (std::vector<Call>{{"second", 3}}));
}

TEST_F(Resume, ARunEndsAfterTheStageThatIsAskedFor) {
  const auto expected = files_of_a_run();
  remove_files();
  run("print", 2);
  EXPECT_TRUE(fs::exists(file_of("second", 3)));
  EXPECT_FALSE(fs::exists(final_file(3)));
  EXPECT_EQ(checks_.size(), 1u);
  run("print", 1);
  EXPECT_TRUE(calls_.empty());
  run();
  EXPECT_EQ(calls_, calls_from({"third", 0}));
  EXPECT_EQ(files(), expected);
}

TEST(PreviousMaps, KeepsDepthsAloneUnlessTheStageAsksForWholeMaps) {
  int reads = 0;
  const auto read = [&](std::size_t image) {
    ++reads;
    return flat_map(image, 2);
  };
  PreviousMaps depths(read, false, 4), whole(read, true, 4);
  EXPECT_TRUE(depths.get(1)->normal.empty());
  EXPECT_TRUE(depths.get(1)->confidence.empty());
  EXPECT_EQ(depth_of(*depths.get(1)), 2);
  EXPECT_EQ(reads, 1);
  EXPECT_FALSE(depths.read(1).normal.empty());
  EXPECT_FALSE(depths.read(1).confidence.empty());
  EXPECT_EQ(reads, 3);
  EXPECT_FALSE(whole.get(1)->normal.empty());
  EXPECT_FALSE(whole.get(1)->confidence.empty());
  EXPECT_EQ(reads, 4);
}

}  // namespace
}  // namespace axial::densify
