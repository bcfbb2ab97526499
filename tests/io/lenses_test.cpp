// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cameras/lenses.h"

#include <gmock/gmock.h>

#include "base/atomic_file.h"
#include "support/captured_events.h"
#include "wrong_input.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using ::testing::HasSubstr;
using Distortion = refractive::LensDistortion<double>;

Distortion fisheye() {
  Distortion lens;
  lens.fisheye = 1;
  lens.spread = 1.1;
  lens.above = {0.9, 0.02, -0.01, 0.002, 1.0 / 3};
  lens.below = {0.01, 0, 0.1};
  lens.p1 = 1e-3;
  lens.prism = {0, -2e-3};
  return lens;
}

Distortion barrel() {
  Distortion lens;
  lens.above[1] = -0.1;
  return lens;
}

class LensesTest : public test::FolderTest {
 protected:
  void add(const std::string& path, std::optional<Distortion> distortion) {
    SceneImage image;
    image.path = path;
    image.camera.width = 640;
    image.camera.height = 480;
    image.camera.lens = {500, 500, 319.5, 239.5};
    image.camera.distortion = distortion;
    scene_.images.push_back(image);
  }

  // The lenses that the images get from the file beside the scene.
  std::vector<std::optional<Distortion>> read_again() {
    Scene again = scene_;
    for (SceneImage& image : again.images) image.camera.distortion = barrel();  // to be replaced
    attach_lenses_beside(again, scene_file_);
    std::vector<std::optional<Distortion>> found;
    for (const SceneImage& image : again.images) found.push_back(image.camera.distortion);
    return found;
  }

  std::string error(const std::string& json) {
    test::put(file_, json);
    return test::error_naming(file_, [&] { attach_lenses_beside(scene_, scene_file_); });
  }

  fs::path scene_file_ = folder_ / "scene.mvs", file_ = folder_ / "scene.lenses.json";
  Scene scene_;
};

// For images in any folders and any assignment of lenses, reading returns what was written.
TEST_F(LensesTest, AreFoundAgainForImagesOfOneBaseName) {
  const std::vector<std::optional<Distortion>> lenses{barrel(), fisheye(), std::nullopt};
  for (std::size_t seed = 0; seed < 27; ++seed) {
    scene_.images.clear();
    std::size_t choice = seed;
    for (const char* folder : {"cam0", "cam1", "cam1/cam0"}) {
      add((folder_ / folder / "0.jpg").string(), lenses[choice % 3]);
      choice /= 3;
    }
    add((folder_ / "other" / "cam0" / "0.jpg").string(), fisheye());
    scene_.images.back().calibrated = false;
    add((folder_ / ".." / "cam1" / "0.jpg").lexically_normal().string(), lenses[seed / 3 % 3]);
    write_lenses_beside(scene_file_, lenses_of(scene_, scene_file_), true);
    std::vector<std::optional<Distortion>> found = read_again();
    for (const std::size_t i : {0u, 1u, 2u, 4u})
      EXPECT_EQ(found[i], scene_.images[i].camera.distortion) << seed << ' ' << i;
  }
}

TEST_F(LensesTest, RefusesEntriesThatSeveralImagesGoBy) {
  add("/x/cam0/0.jpg", {});
  add("/x/cam1/0.jpg", {});
  SceneLenses lenses;
  lenses.lenses["wide"] = barrel();
  lenses.images["0.jpg"] = "wide";
  write_lenses(file_, lenses);
  EXPECT_EQ(
      error_of([&] { attach_lenses_beside(scene_, scene_file_); }),
      file_.string() +
          ": lenses.images.0.jpg matches /x/cam0/0.jpg and /x/cam1/0.jpg: give more of the path");
}

TEST_F(LensesTest, ReadsBackWhatItWrites) {
  add((folder_ / "images/a.jpg").string(), fisheye());
  add((folder_ / "images/b.jpg").string(), std::nullopt);
  add((folder_ / "more/images/b.jpg").string(), fisheye());
  add((folder_ / "../elsewhere/b.jpg").string(), barrel());
  write_lenses_beside(scene_file_, lenses_of(scene_, scene_file_), false);
  EXPECT_EQ(read_lenses(file_).lenses.size(), 2u);
  EXPECT_EQ(read_again(),
            (std::vector<std::optional<Distortion>>{fisheye(), std::nullopt, fisheye(), barrel()}));
  const std::string bytes = read_file(file_);
  write_lenses(file_, read_lenses(file_));
  EXPECT_EQ(read_file(file_), bytes);
}

TEST_F(LensesTest, FollowsASceneThatIsMoved) {
  add((folder_ / "images/a.jpg").string(), fisheye());
  add((folder_ / "images/b.jpg").string(), barrel());
  write_lenses_beside(scene_file_, lenses_of(scene_, scene_file_), false);
  scene_.images[0].path = "/somewhere/else/images/a.jpg";
  scene_.images[1].path = "images/b.jpg";
  EXPECT_EQ(read_again(), (std::vector<std::optional<Distortion>>{fisheye(), barrel()}));
}

// Entries are ends of paths: "left/a.jpg" for the second image, and "a.jpg" for the first one,
// which is also an end of the second path.
TEST_F(LensesTest, RefusesImagesThatTheEndsOfTheirPathsDoNotTellApart) {
  add((folder_ / "a.jpg").string(), fisheye());
  add((folder_ / folder_.filename() / "a.jpg").string(), barrel());
  const std::string message = error_of([&] { lenses_of(scene_, scene_file_); });
  EXPECT_THAT(message, HasSubstr(file_.string()));
  EXPECT_THAT(message, HasSubstr("rename a folder"));
}

TEST_F(LensesTest, StraightLensesHaveNoFileAndLeaveNone) {
  add("a.jpg", barrel());
  write_lenses_beside(scene_file_, lenses_of(scene_, scene_file_), false);
  EXPECT_TRUE(fs::exists(file_));
  scene_.images[0].camera.distortion.reset();
  write_lenses_beside(scene_file_, lenses_of(scene_, scene_file_), false);
  EXPECT_FALSE(fs::exists(file_));
  EXPECT_FALSE(attach_lenses_beside(scene_, scene_file_));
}

TEST_F(LensesTest, StraightLensesBehindPortsAreSaidToBeSo) {
  add("a.jpg", std::nullopt);
  write_lenses_beside(scene_file_, lenses_of(scene_, scene_file_), true);
  EXPECT_TRUE(read_lenses(file_).lenses.empty());
  EXPECT_FALSE(attach_lenses_beside(scene_, scene_file_));
}

constexpr const char* kExample = R"({ "version": 1, "default": "main", "lenses": { "main":
  { "type": "perspective", "radial": [1, -0.1] } }, "images": { "a.jpg": "none" } })";

TEST_F(LensesTest, WhatIsLeftOutIsStraight) {
  test::put(file_, kExample);
  add("b.jpg", std::nullopt);
  add("a.jpg", barrel());
  EXPECT_TRUE(attach_lenses_beside(scene_, scene_file_));
  EXPECT_EQ(scene_.images[0].camera.distortion, barrel());
  EXPECT_FALSE(scene_.images[1].camera.distortion);
}

TEST_F(LensesTest, NamesKeyAndValue) {
  add("b.jpg", std::nullopt);
  const auto with = [&](const std::string& from, const std::string& to) {
    return error(test::replaced(kExample, from, to));
  };
  EXPECT_THAT(with("\"version\": 1", "\"version\": 2"), HasSubstr("version is 2"));
  EXPECT_THAT(with("perspective", "catadioptric"), HasSubstr("main.type is 'catadioptric'"));
  EXPECT_THAT(with("-0.1]", "0, 0, 0, 0, 0]"), HasSubstr("main.radial is [1,0,0,0,0,0]"));
  EXPECT_THAT(with("-0.1", "\"x\""), HasSubstr("main.radial[1] is \"x\", expected a number"));
  EXPECT_THAT(with("[1,", "[0,"), HasSubstr("main.radial begins with 0"));
  EXPECT_THAT(with("\"radial\"", "\"spread\": -1, \"radial\""), HasSubstr("main.spread is -1"));
  EXPECT_THAT(with("\"radial\"", "\"k1\": 1, \"radial\""), HasSubstr("'k1'"));
  EXPECT_THAT(with("\"none\"", "\"other\""), HasSubstr("images.a.jpg is 'other'"));
  EXPECT_THAT(with("\"default\": \"main\"", "\"default\": \"other\""),
              HasSubstr("default is 'other'"));
  EXPECT_THAT(with("{ \"main\":", "{ \"none\":"), HasSubstr("'none' cannot be the name"));
  // The lens folds back at its centre.
  EXPECT_THAT(with("-0.1]", "-0.1], \"tangential\": [999, 999], \"thin_prism\": [99, 0]"),
              HasSubstr("lenses.main: is not a valid lens for b.jpg"));
}

TEST_F(LensesTest, RefusesNumbersThatAreNotFinite) {
  EXPECT_THAT(error(R"({ "version": 1, "default": "main", "lenses": { "main":
                    { "type": "perspective", "radial": [1, 1e999] } } })"),
              HasSubstr("1e999"));
}

TEST_F(LensesTest, RefusesAFileThatIsNotThere) {
  const std::string message = error_of([&] { read_lenses(folder_ / "none.json"); });
  EXPECT_THAT(message, HasSubstr((folder_ / "none.json").string()));
  EXPECT_THAT(message, HasSubstr("No such file"));
}

TEST_F(LensesTest, WarnsOfNamesThatNoImageHas) {
  test::put(file_, kExample);
  add("b.jpg", std::nullopt);
  test::CapturedEvents log;
  attach_lenses_beside(scene_, scene_file_, log.context);
  EXPECT_THAT(log.lines, HasSubstr(file_.string() + ": no image matches images.a.jpg"));
}

TEST_F(LensesTest, SurvivesDamage) {
  add("b.jpg", std::nullopt);
  test::expect_damage_survived(file_, kExample,
                               [&](const fs::path&) { attach_lenses_beside(scene_, scene_file_); });
}

}  // namespace
}  // namespace axial::io
