// SPDX-License-Identifier: GPL-3.0-or-later
// Which photographs of a rig belong together.
#include "pose/rig_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/error_of.h"

namespace axial::pose {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string kFile = "rig_config.json";

io::RigFile stereo(const std::string& left = "left/", const std::string& right = "right/") {
  io::RigFile file;
  file.by_prefix = true;
  io::RigCamera reference, other;
  reference.prefix = left;
  reference.is_reference = true;
  other.prefix = right;
  other.pose = Pose{Eigen::Matrix3d::Identity(), {0.2, 0, 0}};
  file.rigs = {{0, {other, reference}}};  // the reference camera need not be the first
  return file;
}

std::vector<io::ColmapImage> images(std::initializer_list<const char*> names) {
  std::vector<io::ColmapImage> result;
  for (const char* name : names) {
    result.emplace_back();
    result.back().id = static_cast<std::uint32_t>(10 + result.size());
    result.back().name = name;
  }
  return result;
}

// The indices of the photographs of each frame.
std::vector<std::vector<std::size_t>> frames_of(const Rig& rig) {
  std::vector<std::vector<std::size_t>> frames;
  for (const RigFrame& frame : rig.frames) {
    frames.emplace_back();
    for (const RigFrame::Image& image : frame.images) frames.back().push_back(image.image);
  }
  return frames;
}

std::vector<double> times_of(const Rig& rig) {
  std::vector<double> times;
  for (const RigFrame& frame : rig.frames) times.push_back(frame.time);
  return times;
}

using Indices = std::vector<std::size_t>;

// The numbers of the names order the frames, and frames without poses leave gaps.
TEST(RigFrames, BelongTogetherByEqualNamesBehindThePrefix) {
  const auto rigs =
      make_rigs(stereo(),
                images({"right/a10.jpg", "left/a9.jpg", "left/a10.jpg", "right/a12.jpg",
                        "left/a12.jpg", "other/a9.jpg", "left/a8.jpg"}),
                {.interval = 0.5}, kFile);
  ASSERT_EQ(rigs.size(), 1u);
  EXPECT_EQ(rigs[0].cameras[0].name, "left/");
  EXPECT_EQ(rigs[0].cameras[1].known, RigCamera::Known::stated);
  EXPECT_THAT(frames_of(rigs[0]),
              ElementsAre(Indices{6}, Indices{1}, Indices{2, 0}, Indices{4, 3}));
  EXPECT_THAT(times_of(rigs[0]), ElementsAre(0, 0.5, 1, 2));
  EXPECT_TRUE(rigs[0].has_seconds);
}

TEST(RigFrames, BelongTogetherByAnExpression) {
  const auto rigs =
      make_rigs(stereo("CAM82-", "CAM83-"),
                images({"CAM82-20210508215908_001-115.tif", "CAM83-20210508215909_001-115.tif",
                        "CAM83-20210508215911_001-116.tif", "CAM82-20210508215910_001-116.tif",
                        "CAM82-test.tif"}),
                {.frames = "-(\\d+)\\.tif$"}, kFile);
  EXPECT_THAT(frames_of(rigs.at(0)), ElementsAre(Indices{0, 1}, Indices{3, 2}));
  EXPECT_FALSE(rigs[0].has_seconds);
}

TEST(RigFrames, BelongTogetherByTime) {
  const auto rigs =
      make_rigs(stereo(), images({"left/a", "left/b", "left/c", "right/p", "right/q", "right/r"}),
                {.times = {{"left/a", 10},
                           {"left/b", 11},
                           {"left/c", 12},
                           {"right/p", 9.6},
                           {"right/q", 11.2},
                           {"right/r", 13}}},
                kFile);
  EXPECT_THAT(frames_of(rigs.at(0)),
              ElementsAre(Indices{0, 3}, Indices{1, 4}, Indices{2}, Indices{5}));
  EXPECT_THAT(times_of(rigs[0]), ElementsAre(10, 11, 12, 13));
}

TEST(RigFrames, AreThoseOfTheModel) {
  io::RigFile file = stereo();
  file.by_prefix = false;
  file.rigs[0].id = 3;
  file.rigs[0].cameras[0].id = 2;
  file.rigs[0].cameras[1].id = 1;
  for (io::RigCamera& camera : file.rigs[0].cameras) camera.prefix.clear();
  file.frames = {{1, 3, {{2, 12}, {1, 11}}}, {2, 3, {{1, 13}}}};
  const auto rigs = make_rigs(file, images({"1.jpg", "1b.jpg", "2.jpg"}), {}, kFile);
  EXPECT_EQ(rigs.at(0).cameras[0].name, "camera 1");
  EXPECT_THAT(frames_of(rigs[0]), ElementsAre(Indices{0, 1}, Indices{2}));
  EXPECT_THAT(test::error_of([&] { make_rigs(file, images({"1.jpg"}), {}, kFile); }),
              HasSubstr("frame 1 has the image 12, which the model does not contain"));
}

TEST(RigFrames, SayWhatIsWrong) {
  const auto error = [](std::initializer_list<const char*> names, const RigOptions& options) {
    return test::error_of([&] { make_rigs(stereo(), images(names), options, kFile); });
  };
  EXPECT_THAT(error({"left/1.jpg", "right/2.jpg"}, {}), HasSubstr("rig_config.json: no two"));
  EXPECT_THAT(error({"left/1.jpg"}, {.frames = "("}), HasSubstr("'(' is not valid"));
  EXPECT_THAT(error({"left/1.jpg"}, {.frames = "1"}), HasSubstr("'1' has no group"));
  EXPECT_THAT(error({"left/1a.jpg", "left/1b.jpg"}, {.frames = "(\\d)"}),
              HasSubstr("'left/1a.jpg' and 'left/1b.jpg' of one camera"));
  EXPECT_THAT(error({"left/1.jpg"}, {.times = {{"left/2.jpg", 1}}}),
              HasSubstr("'left/1.jpg' of the rig has no time"));
  io::RigFile free = stereo();
  free.rigs[0].cameras[0].pose.reset();
  const auto names = images({"left/1.jpg", "right/1.jpg"});
  EXPECT_THAT(
      test::error_of([&] { make_rigs(free, names, {.poses = RigCamera::Known::fixed}, kFile); }),
      HasSubstr("states no pose of right/"));
  EXPECT_EQ(make_rigs(free, names, {}, kFile)[0].cameras[1].known, RigCamera::Known::free);
}

}  // namespace
}  // namespace axial::pose
