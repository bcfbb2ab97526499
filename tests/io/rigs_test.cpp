// SPDX-License-Identifier: GPL-3.0-or-later
// Files of rigs, frames and times.
#include "io/colmap/rigs.h"

#include <gmock/gmock.h>

#include <cstring>

#include "io/cameras/photograph_numbers.h"
#include "wrong_input.h"

namespace axial::io {
namespace {

using test::error_naming;
using test::put;
using test::replaced;
using ::testing::HasSubstr;

// A stereo rig, as COLMAP documents it, with this project's standard deviations.
constexpr const char* kConfig = R"([{"cameras": [
  {"image_prefix": "rig1/cam1/", "ref_sensor": true},
  {"image_prefix": "rig1/cam2/", "cam_from_rig_rotation": [0.5, 0.5, 0.5, 0.5],
   "cam_from_rig_translation": [0.1, 0.2, 0.3], "sigma_translation": 0.001, "sigma_rotation": 0.1},
  {"image_prefix": "rig1/cam3/", "camera_model_name": "PINHOLE", "camera_params": [1, 1, 1, 1]}]}])";
constexpr const char* kRigs =
    "# Rig calib list with one line of data per calib:\n"
    "1 3 CAMERA 4 CAMERA 7 1 0.5 0.5 0.5 0.5 0.1 0.2 0.3 IMU 1 0\n"
    "2 1 CAMERA 9\n";
constexpr const char* kFrames =
    "# Frame list with one line of data per frame:\n"
    "1 1 1 0 0 0 0 0 0 3 CAMERA 4 11 CAMERA 7 12 IMU 1 5\n"
    "2 2 1 0 0 0 0 0 0 1 CAMERA 9 13\n";

class RigsTest : public test::FolderTest {
 protected:
  RigFile read(const std::string& name) const { return read_rigs(folder_ / name); }
  std::string error(const std::string& name, const std::string& named = "") const {
    return error_naming(folder_ / (named.empty() ? name : named), [&] { read(name); });
  }
};

template <class... Values>
std::string bytes_of(Values... values) {
  std::string bytes;
  const auto add = [&](auto value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
  };
  (add(values), ...);
  return bytes;
}

std::string id(std::uint32_t value) {
  return bytes_of(value);
}

// The same rigs and frames as in the text files.
std::string binary_rigs() {
  return bytes_of(std::uint64_t{2}) + id(1) + id(3) + id(0) + id(4) + id(0) + id(7) + '\1' +
         bytes_of(0.5, 0.5, 0.5, 0.5, 0.1, 0.2, 0.3) + id(1) + id(1) + '\0' + id(2) + id(1) +
         id(0) + id(9);
}

std::string binary_frames() {
  const auto image = [](std::uint32_t type, std::uint32_t sensor, std::uint64_t data) {
    return id(type) + id(sensor) + bytes_of(data);
  };
  const std::string pose = bytes_of(1., 0., 0., 0., 0., 0., 0.);
  return bytes_of(std::uint64_t{2}) + id(1) + id(1) + pose + id(3) + image(0, 4, 11) +
         image(0, 7, 12) + image(1, 1, 5) + id(2) + id(2) + pose + id(1) + image(0, 9, 13);
}

void expect_stated_pose(const RigCamera& camera) {
  ASSERT_TRUE(camera.pose);
  // x in the camera is R x + t: a third of a turn about the diagonal moves x to y.
  EXPECT_TRUE(camera.pose->to_camera({1, 0, 0}).isApprox(Eigen::Vector3d(0.1, 1.2, 0.3), 1e-12));
}

TEST_F(RigsTest, ReadsAConfiguration) {
  put(folder_ / "rig_config.json", kConfig);
  const RigFile file = read("rig_config.json");
  EXPECT_TRUE(file.by_prefix);
  ASSERT_EQ(file.rigs.size(), 1u);
  const auto& cameras = file.rigs[0].cameras;
  ASSERT_EQ(cameras.size(), 3u);
  EXPECT_EQ(cameras[0].prefix, "rig1/cam1/");
  EXPECT_TRUE(cameras[0].is_reference);
  EXPECT_FALSE(cameras[0].pose);
  expect_stated_pose(cameras[1]);
  EXPECT_EQ(cameras[1].sigma_translation, 0.001);
  EXPECT_EQ(cameras[1].sigma_rotation, 0.1);
  EXPECT_FALSE(cameras[2].pose);
}

TEST_F(RigsTest, ReadsTheFilesOfModels) {
  put(folder_ / "rigs.txt", kRigs);
  put(folder_ / "frames.txt", kFrames);
  put(folder_ / "rigs.bin", binary_rigs());
  put(folder_ / "frames.bin", binary_frames());
  for (const char* name : {"rigs.txt", "rigs.bin"}) {
    const RigFile file = read(name);
    EXPECT_FALSE(file.by_prefix);
    ASSERT_EQ(file.rigs.size(), 2u);
    ASSERT_EQ(file.rigs[0].cameras.size(), 2u);  // without the IMU
    EXPECT_EQ(file.rigs[0].cameras[0].id, 4u);
    EXPECT_TRUE(file.rigs[0].cameras[0].is_reference);
    expect_stated_pose(file.rigs[0].cameras[1]);
    ASSERT_EQ(file.frames.size(), 2u);
    ASSERT_EQ(file.frames[0].images.size(), 2u);
    EXPECT_EQ(file.frames[0].images[1].camera, 7u);
    EXPECT_EQ(file.frames[0].images[1].image, 12u);
  }
}

TEST_F(RigsTest, RefusesWrongConfigurations) {
  const auto wrong = [&](const std::string& from, const std::string& to) {
    put(folder_ / "rig.json", replaced(kConfig, from, to));
    return error("rig.json");
  };
  EXPECT_THAT(wrong("\"ref_sensor\": true", "\"ref_sensor\": false"), HasSubstr("has 0 cameras"));
  EXPECT_THAT(wrong("\"ref_sensor\": true", "\"ref_sensor\": 1"), HasSubstr("expected true"));
  EXPECT_THAT(wrong("image_prefix", "prefix"), HasSubstr("unknown key 'prefix'"));
  EXPECT_THAT(wrong("rig1/cam2/", "rig1/cam1/"), HasSubstr("'rig1/cam1/' occurs twice"));
  EXPECT_THAT(wrong("[0.5, 0.5, 0.5, 0.5]", "[0.5, 0.5]"),
              HasSubstr("camera 2.cam_from_rig_rotation is [0.5,0.5], expected 4 numbers"));
  EXPECT_THAT(wrong("[0.5, 0.5, 0.5, 0.5]", "[0, 0, 0, 0]"), HasSubstr("rig 1, camera 2"));
  EXPECT_THAT(wrong("\"cam_from_rig_translation\": [0.1, 0.2, 0.3],", ""),
              HasSubstr(".cam_from_rig_translation is missing"));
  EXPECT_THAT(wrong("0.001", "0"), HasSubstr("sigma_translation is 0, expected a value above 0"));
  put(folder_ / "rig.json", "{}");
  EXPECT_THAT(error("rig.json"), HasSubstr("is not a list of rigs"));
}

TEST_F(RigsTest, RefusesWrongFilesOfModels) {
  const auto wrong = [&](const std::string& rigs, const std::string& frames) {
    put(folder_ / "rigs.txt", rigs);
    put(folder_ / "frames.txt", frames);
    return error("rigs.txt", rigs == kRigs ? "frames.txt" : "rigs.txt");
  };
  EXPECT_THAT(wrong(replaced(kRigs, "7 1 0.5", "7 2 0.5"), kFrames), HasSubstr("HAS_POSE is 2"));
  EXPECT_THAT(wrong(replaced(kRigs, "CAMERA 7", "CAMERA 4"), kFrames), HasSubstr("occurs twice"));
  EXPECT_THAT(wrong(replaced(kRigs, "2 1 CAMERA", "2 1 IMU"), kFrames), HasSubstr("is no camera"));
  EXPECT_THAT(wrong(replaced(kRigs, "2 1 C", "1 1 C"), kFrames), HasSubstr("rig 1 occurs twice"));
  EXPECT_THAT(wrong(kRigs, replaced(kFrames, "2 2 1", "2 5 1")), HasSubstr("of rig 5"));
  EXPECT_THAT(wrong(kRigs, replaced(kFrames, "A 9", "A 4")), HasSubstr("camera 4, which is not"));
  EXPECT_THAT(wrong(kRigs, replaced(kFrames, "A 7", "A 4")), HasSubstr("two images of camera 4"));
  EXPECT_THAT(wrong(kRigs, replaced(kFrames, "9 13", "9 13 14")), HasSubstr("'14' follows"));
  EXPECT_THAT(test::error_of([&] { read("rigs.xml"); }), HasSubstr("ends with .json"));
}

TEST_F(RigsTest, RefusesFilesThatAreCutOff) {
  const std::string rigs = binary_rigs(), frames = binary_frames();
  for (std::size_t size = 0; size < rigs.size(); ++size) {
    put(folder_ / "rigs.bin", rigs.substr(0, size));
    put(folder_ / "frames.bin", frames);
    error("rigs.bin");
  }
  put(folder_ / "rigs.bin", rigs);
  for (std::size_t size = 0; size < frames.size(); ++size) {
    put(folder_ / "frames.bin", frames.substr(0, size));
    error("rigs.bin", "frames.bin");
  }
  put(folder_ / "frames.bin", frames + "x");
  EXPECT_THAT(error("rigs.bin", "frames.bin"), HasSubstr("1 bytes follow"));
}

TEST_F(RigsTest, ReadsTimes) {
  const std::filesystem::path file = folder_ / "times.csv";
  put(file, "name,seconds\n# a comment\nleft/a,b.jpg, 1.5\n\nright/a.jpg,-2e1\n");
  EXPECT_EQ(read_photograph_numbers(file, "seconds"),
            (PhotographNumbers{{"left/a,b.jpg", 1.5}, {"right/a.jpg", -20}}));
  for (const auto& [text, expected] : std::map<std::string, std::string>{
           {"a.jpg 1\n", "line 1: 'a.jpg 1' is not name,seconds"},
           {"a.jpg,x\n", "seconds: 'x' is not a valid number"},
           {",1\n", "the name is missing"},
           {"a.jpg,1\na.jpg,2\n", "line 2: the photograph 'a.jpg' occurs twice"},
           {"name,seconds\n", "contains no photograph"}}) {
    put(file, text);
    EXPECT_THAT(error_naming(file, [&] { read_photograph_numbers(file, "seconds"); }),
                HasSubstr(expected));
  }
}

}  // namespace
}  // namespace axial::io
