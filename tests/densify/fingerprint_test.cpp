// SPDX-License-Identifier: GPL-3.0-or-later
// What the fingerprint of the depth maps depends on.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <functional>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/atomic_file.h"
#include "base/parallel.h"
#include "densify/project.h"
#include "support/analytic_scene.h"
#include "support/empty_folder.h"

namespace axial::densify {
namespace {

struct Input {
  Project project;
  MatchOptions matching;
};

std::string print_of(const Input& input) {
  return fingerprint(input.project, input.matching);
}

// Two images that see one point. The contents of the files do not matter here.
class FingerprintTest : public testing::Test {
 protected:
  FingerprintTest() {
    Project& project = input_.project;
    const std::vector<Pose> poses = test::circle_of_poses(2);
    project.scene = test::scene_of(test::behind_port(test::dry_camera()), poses);
    project.scene.points.resize(1);
    project.preparations.resize(2);
    project.preparations[0].init_points = {0};
    project.neighbours = {{{.image = 1}}, {{.image = 0}}};
    project.sources = project.neighbours;
    for (std::uint32_t i = 0; i < 2; ++i) {
      const std::filesystem::path path = folder_ / ("image" + std::to_string(i));
      write_atomically(path, "pixels");
      project.views.push_back({project.scene.images[i].camera, poses[i], i, i, path, {}, {}});
    }
    write_atomically(folder_ / "other", "other pixels");
  }

  std::string after(const std::function<void(Input&)>& change) const {
    Input changed = input_;
    change(changed);
    return print_of(changed);
  }

  const std::filesystem::path folder_ = test::empty_folder();
  Input input_;
};

TEST_F(FingerprintTest, ChangesWithEverythingThatTheDepthMapsDependOn) {
  using Port = refractive::FlatPort<double>;
  const std::vector<std::function<void(Input&)>> changes{
      [](Input&) {},
      [](Input& in) { in.matching.warp = depth::Warp::homography; },
      [](Input& in) { in.matching.projection = ProjectionMethod::line_search; },
      [](Input& in) { in.project.views[1].id = 7; },
      [](Input& in) { in.project.views[1].camera.lens.fx += 1e-9; },
      [](Input& in) { in.project.views[1].camera.width = 48; },
      [](Input& in) { std::get<Port>(*in.project.views[1].camera.port).distance += 1e-9; },
      [](Input& in) { in.project.views[1].camera.port.reset(); },
      [](Input& in) { in.project.views[1].camera.distortion.emplace(); },
      [](Input& in) { in.project.views[1].pose.centre.z() += 1e-9; },
      [](Input& in) { in.project.views[1].pose.rotation(0, 1) += 1e-9; },
      [](Input& in) { in.project.views[1].header.alpha = true; },
      [](Input& in) { in.project.views[1].header.bits = 16; },
      [&](Input& in) { in.project.views[1].mask = folder_ / "other"; },
      [&](Input& in) { in.project.views[1].file = folder_ / "other"; },
      [](Input& in) { in.project.neighbours[1].clear(); },
      [](Input& in) { in.project.sources[1].clear(); },
      [](Input& in) { in.project.scene.points[0].position.x() += 1; },
      [](Input& in) { in.project.preparations[0].init_points.clear(); }};
  std::set<std::string> prints;
  for (std::size_t i = 0; i < changes.size(); ++i)
    EXPECT_TRUE(prints.insert(after(changes[i])).second) << "change " << i;
}

TEST_F(FingerprintTest, DoesNotDependOnThreadsAndPictures) {
  const std::string print = after([](Input&) {});
  EXPECT_EQ(print, after([](Input& in) {
              in.matching.overwrite_dmaps = true;
              in.matching.pictures = Pictures::final_maps;
            }));
  const ThreadLimit one(1);
  EXPECT_EQ(print, after([](Input&) {}));
}

// The same file under another name.
TEST_F(FingerprintTest, DependsOnTheContentsOfFilesAndNotOnTheirNames) {
  EXPECT_EQ(after([](Input&) {}),
            after([](Input& in) { in.project.views[1].file = in.project.views[0].file; }));
}

// One image behind a flat port. All numbers are written out, so that no mathematical library
// changes their last bits.
Input written_out_input(const std::filesystem::path& image) {
  CameraModel camera;
  camera.width = 96;
  camera.height = 72;
  camera.lens = {75, 74, 47.5, 36.25};
  refractive::FlatPort<double> port;
  port.distance = 0.02;
  port.thickness = 0.014;
  port.n_glass = 1.52;
  port.n_water = 1.333;
  camera.port = port;
  Pose pose;
  pose.centre = {0.5, -0.25, 1};
  Input input;
  Project& project = input.project;
  project.scene = test::scene_of(camera, {pose});
  write_atomically(image, "pixels");
  project.scene.points.resize(1);
  project.scene.points[0].position = {1, 2, 3};
  project.preparations.resize(1);
  project.preparations[0].init_points = {0};
  project.neighbours = {{{.image = 4}}};
  project.sources = {{{.image = 4}, {.image = 5}}};
  project.views.push_back({camera, pose, 0, 3, image, {}, {}});
  return input;
}

// The side files of existing depth maps hold fingerprints. If one of these fingerprints changes,
// all maps are made again, which only a new version of the matching method may do. The expected
// digests are those of XXH3 for the same bytes, computed by another program.
TEST(KnownFingerprints, StayAsTheyAre) {
  using Change = void (*)(MatchOptions&);
  const Input input = written_out_input(test::empty_folder() / "image");
  for (const auto& [expected, change] : std::vector<std::pair<std::string, Change>>{
           {"ba0b4fc4b3102bf03b1ccba744836aee", [](MatchOptions&) {}},
           {"4120aeb0ce35a60bc1a716167f8a0093", [](MatchOptions& in) { in.iterations = 5; }},
           {"064875871470e66d1404172d734859ad", [](MatchOptions& in) { in.keep_cost = 1.5f; }},
           {"a448bba4a16354dc50fa6fc81d9e5ab8", [](MatchOptions& in) { in.min_texture = 4e-4f; }},
           {"e6d250b4b4fc37952db240ca8b27c592",
            [](MatchOptions& in) { in.geometric_weight = 0.5f; }},
           {"9e44a999a5285088a2793d4fd689f1c5", [](MatchOptions& in) { in.later_pairs = 3; }},
           {"595a05b0ad487da2e77b53879931991c",
            [](MatchOptions& in) { in.speckles.min_pixels = 7; }},
           {"f13552691e99fb6f6e3c659e086f3f15", [](MatchOptions& in) { in.gaps.max_gap = 3; }},
           {"de88be94ea1d2c157de0478c1e0706b8", [](MatchOptions& in) {
              in.keep_cost = 1.5f;
              in.speckles.min_pixels = 7;
              in.gaps.max_gap = 3;
            }}}) {
    MatchOptions changed = input.matching;
    change(changed);
    EXPECT_EQ(fingerprint(input.project, changed), expected);
  }
}

// Calls visit(number) for each number that depth maps depend on. The structured bindings name all
// members: a new member does not compile until the test names it.
template <class Visit>
void each_number(Input& input, const Visit& visit) {
  auto& [warp, levels, iterations, coarsest_side, sigma_color, sigma_space, min_texture, smoothness,
         prior_texture, coarse_pairs, first_pairs, later_pairs, last_pairs, refinement_shrink,
         restart_trials, refinement_pixels, refinement_angle, good_cost, fair_cost, bad_cost,
         search_planes, search_pairs, certain_cost, keep_cost, geometric_weight, geometric_limit] =
      static_cast<depth::PatchMatchOptions&>(input.matching);
  auto& [depth_sigma, depth_bonus, normal_sigma, normal_bonus] = smoothness;
  auto& [speckle_difference, min_pixels] = input.matching.speckles;
  auto& [max_gap, gap_difference] = input.matching.gaps;
  const auto each = [&](auto&... numbers) { (visit(numbers), ...); };
  each(levels, iterations, coarsest_side, sigma_color, sigma_space, min_texture, prior_texture,
       coarse_pairs, first_pairs, later_pairs, last_pairs, refinement_shrink, restart_trials,
       refinement_pixels, refinement_angle, good_cost, fair_cost, bad_cost, search_planes,
       search_pairs, certain_cost, keep_cost, geometric_weight, geometric_limit);
  each(depth_sigma, depth_bonus, normal_sigma, normal_bonus, speckle_difference, min_pixels,
       max_gap, gap_difference, input.matching.geometric_iterations, input.matching.postprocess,
       input.project.options.ignore_mask_label);
}

// Adds `steps` to one of the numbers.
void step(Input& input, int place, int steps) {
  int i = 0;
  each_number(input, [&](auto& number) {
    using Number = std::remove_reference_t<decltype(number)>;
    if (i++ == place) number = static_cast<Number>(number + static_cast<Number>(steps));
  });
}

std::vector<double> numbers(Input input) {
  std::vector<double> all;
  each_number(input, [&](const auto& number) { all.push_back(static_cast<double>(number)); });
  return all;
}

// A fingerprint contains only the numbers that differ from their defaults. If this test fails,
// raise the version in fingerprint(), so that maps made with the earlier defaults are not used.
TEST(FingerprintOfOptions, DefaultsAreThoseOfTheVersion) {
  const std::vector<double> defaults{
      1,    2,    64,       0.1,    3,     3.6e-5, 0.002, 4,     2,    2,   0,    0.65,
      3,    2,    0.488692, 0.594,  0.81,  0.99,   4,     2,     0.15, 1.2, 0.25, 4,
      0.02, 0.07, 0.226893, 0.0672, 0.007, 100,    7,     0.025, 2,    3,   -1};
  EXPECT_THAT(numbers({}), testing::Pointwise(testing::DoubleNear(1e-6), defaults));
}

TEST(FingerprintOfOptions, ChangesWithEachNumber) {
  const std::size_t count = numbers({}).size();
  std::set<std::string> prints{print_of({})};
  for (std::size_t place = 0; place < count; ++place) {
    Input changed;
    step(changed, static_cast<int>(place), 1);
    EXPECT_TRUE(prints.insert(print_of(changed)).second) << "number " << place;
  }
}

RC_GTEST_PROP(FingerprintOfOptions, IsTheSameForEqualNumbersAlone, ()) {
  const auto count = static_cast<int>(numbers({}).size());
  const auto some_step = [&](Input& input) {
    step(input, *rc::gen::inRange(0, count), *rc::gen::inRange(0, 3));
  };
  Input one;
  for (int i = 0; i < 4; ++i) some_step(one);
  Input other = one;
  some_step(other);
  RC_ASSERT((print_of(one) == print_of(other)) == (numbers(one) == numbers(other)));
}

}  // namespace
}  // namespace axial::densify
