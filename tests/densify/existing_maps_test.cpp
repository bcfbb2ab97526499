// SPDX-License-Identifier: GPL-3.0-or-later
// The decisions about depth maps that are in the working folder before a run.
#include "densify/existing_maps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "support/analytic_scene.h"
#include "support/empty_folder.h"
#include "support/error_of.h"

namespace axial::densify {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

// Three images, whose maps are in the working folder.
class ExistingMapsTest : public testing::Test {
 protected:
  ExistingMapsTest() {
    project_.options.files.working_folder = test::empty_folder();
    const std::vector<Pose> poses = test::circle_of_poses(3);
    project_.scene = test::scene_of(test::dry_camera(), poses);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      project_.views.push_back(
          {test::dry_camera(), poses[i], i, static_cast<std::uint32_t>(i), {}, {}, {}});
      project_.references.push_back(i), project_.part.push_back(i);
    }
  }

  void write_map(std::size_t image, const CameraModel& camera = test::dry_camera()) {
    DepthMap map = test::exact_map({}, camera, project_.views[image].pose);
    map.ids = {project_.views[image].id};
    io::write_dmap(file(image), map, "print photometric");
  }

  void make_foreign(std::size_t image) { fs::remove(file(image).string() + ".json"); }
  void make_damaged(std::size_t image) { fs::resize_file(file(image), 100); }

  fs::path file(std::size_t image) const { return depth_map_path(project_, image); }
  ExistingMaps found() const { return find_existing_maps(project_, true); }

  Project project_;
};

TEST_F(ExistingMapsTest, TellsTheOriginOfEachMap) {
  for (const std::size_t image : {0u, 1u, 2u}) write_map(image);
  make_foreign(1);
  make_damaged(2);
  const ExistingMaps maps = found();
  EXPECT_EQ(maps.states[0].origin, io::DmapOrigin::ours);
  EXPECT_EQ(maps.states[0].made_from, "print photometric");
  EXPECT_EQ(maps.states[1].origin, io::DmapOrigin::foreign);
  EXPECT_EQ(maps.states[2].origin, io::DmapOrigin::damaged);
  project_.part = {0, 2};
  EXPECT_EQ(found().states[1].origin, io::DmapOrigin::none);
}

TEST_F(ExistingMapsTest, ForeignMapsAreOverwrittenOnlyIfAllowed) {
  for (const std::size_t image : {0u, 1u}) write_map(image);
  make_damaged(0);
  EXPECT_NO_THROW(check_overwriting(project_, false, found()));
  make_foreign(1);
  const auto error = [&] {
    return test::error_of([&] { check_overwriting(project_, false, found()); });
  };
  EXPECT_THAT(error(), AllOf(HasSubstr(file(1).string()), HasSubstr("1 of 3"),
                             HasSubstr("make_maps false"), HasSubstr("overwrite_dmaps true")));
  // A foreign map counts as that of a pinhole: behind a port it cannot be fused.
  project_.scene.images[1].camera = test::behind_port(test::dry_camera());
  EXPECT_THAT(error(), AllOf(Not(HasSubstr("make_maps false")), HasSubstr("overwrite_dmaps true")));
  EXPECT_NO_THROW(check_overwriting(project_, true, found()));
}

TEST_F(ExistingMapsTest, KeepsImagesWithMapsAtTheResolutionOfTheirMaps) {
  write_map(0);
  write_map(2, test::dry_camera().resized(48, 36));
  make_foreign(2);
  keep_images_with_maps(project_, found());
  EXPECT_EQ(project_.references, (std::vector<std::size_t>{0, 2}));
  EXPECT_EQ(project_.views[0].camera.width, 96);
  EXPECT_EQ(project_.views[2].camera.width, 48);
}

TEST_F(ExistingMapsTest, RefusesMapsThatCannotBeFused) {
  const auto error = [&] {
    Project project = project_;
    return test::error_of([&] { keep_images_with_maps(project, found()); });
  };
  EXPECT_THAT(error(), HasSubstr("no depth map found: " + file(0).string()));
  write_map(1);
  project_.scene.images[1].pose.centre.x() += 0.1;
  EXPECT_THAT(error(), AllOf(HasSubstr(file(1).string()), HasSubstr("other poses or intrinsics")));
  make_damaged(1);
  EXPECT_THAT(error(), AllOf(HasSubstr(file(1).string()), HasSubstr("is damaged")));
  write_map(1);
  make_foreign(1);
  project_.scene.images[1].camera = test::behind_port(test::dry_camera());
  EXPECT_THAT(error(), AllOf(HasSubstr(file(1).string()), HasSubstr("has a port")));
}

}  // namespace
}  // namespace axial::densify
