// SPDX-License-Identifier: GPL-3.0-or-later
// What the fingerprint of the depth maps depends on.
#include "densify/fingerprint.h"

#include <gtest/gtest.h>

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/parallel.h"
#include "support/analytic_scene.h"
#include "support/empty_folder.h"

namespace axial::densify {
namespace {

struct Input {
  Project project;
  Settings settings;
};

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
      project.scene.images[i].path = (folder_ / ("image" + std::to_string(i))).string();
      write_atomically(project.scene.images[i].path, "pixels");
      project.views.push_back({i, project.scene.images[i].camera, poses[i], {}, {}});
    }
    write_atomically(folder_ / "other", "other pixels");
  }

  std::string after(const std::function<void(Input&)>& change) const {
    Input changed = input_;
    change(changed);
    return fingerprint(changed.project, changed.settings);
  }

  const std::filesystem::path folder_ = test::empty_folder();
  Input input_;
};

TEST_F(FingerprintTest, ChangesWithEverythingThatTheDepthMapsDependOn) {
  using Port = refractive::FlatPort<double>;
  const std::vector<std::function<void(Input&)>> changes{
      [](Input&) {},
      [](Input& in) { in.settings.matching.iterations = 5; },
      [](Input& in) { in.settings.matching.sub_resolution_levels = 0; },
      [](Input& in) { in.settings.matching.warp = depth::Warp::homography; },
      [](Input& in) { in.settings.projection = ProjectionMethod::line_search; },
      [](Input& in) { in.settings.geometric_iterations = 1; },
      [](Input& in) { in.settings.postprocess = kSpeckles; },
      [](Input& in) { in.settings.ignore_mask_label = 3; },
      [](Input& in) { in.settings.map_settings = "Speckle Size 7\n"; },
      [](Input& in) { in.project.views[1].id = 7; },
      [](Input& in) { in.project.views[1].camera.lens.fx += 1e-9; },
      [](Input& in) { in.project.views[1].camera.width = 48; },
      [](Input& in) { std::get<Port>(*in.project.views[1].camera.port).distance += 1e-9; },
      [](Input& in) { in.project.views[1].camera.port.reset(); },
      [](Input& in) { in.project.views[1].camera.distortion.emplace(); },
      [](Input& in) { in.project.views[1].pose.centre.z() += 1e-9; },
      [](Input& in) { in.project.views[1].pose.rotation(0, 1) += 1e-9; },
      [](Input& in) { in.project.views[1].file.alpha = true; },
      [](Input& in) { in.project.views[1].file.bits = 16; },
      [&](Input& in) { in.project.views[1].mask = folder_ / "other"; },
      [&](Input& in) { in.project.scene.images[1].path = (folder_ / "other").string(); },
      [](Input& in) { in.project.neighbours[1].clear(); },
      [](Input& in) { in.project.sources[1].clear(); },
      [](Input& in) { in.project.scene.points[0].position.x() += 1; },
      [](Input& in) { in.project.preparations[0].init_points.clear(); }};
  std::set<std::string> prints;
  for (std::size_t i = 0; i < changes.size(); ++i)
    EXPECT_TRUE(prints.insert(after(changes[i])).second) << "change " << i;
}

TEST_F(FingerprintTest, DoesNotDependOnFusionMemoryAndThreads) {
  const std::string print = after([](Input&) {});
  EXPECT_EQ(print, after([](Input& in) {
              in.settings.fusion.min_views = 7;
              in.settings.estimate_colors = 0;
              in.settings.crop_to_roi = false;
              in.settings.max_memory = 1000;
              in.settings.max_threads = 1;
              in.settings.output = "elsewhere.mvs";
            }));
  const ThreadLimit one(1);
  EXPECT_EQ(print, after([](Input&) {}));
}

// The same file under another name.
TEST_F(FingerprintTest, DependsOnTheContentsOfFilesAndNotOnTheirNames) {
  EXPECT_EQ(after([](Input&) {}), after([](Input& in) {
              in.project.scene.images[1].path = in.project.scene.images[0].path;
            }));
}

}  // namespace
}  // namespace axial::densify
