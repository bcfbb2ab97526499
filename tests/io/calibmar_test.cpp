// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/colmap/calibmar.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/atomic_file.h"
#include "io/cameras/housing.h"
#include "io/wrong_input.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Calibmar : public test::FolderTest {
 protected:
  fs::path written(const std::string& text) const {
    write_atomically(folder_ / "calibration.yaml", text);
    return folder_ / "calibration.yaml";
  }

  std::string error_of(const std::string& text) const {
    return test::error_of([&] { read_calibmar(written(text)); });
  }
};

const std::string kFlat =
    "# RMS 0.31 px, standard deviations: 0.1, 0.2\n"
    "model: OPENCV\n"
    "parameters: [1200.5, 1201, 960, 540.25, -0.1, 0.02, 1e-4, -2e-4]  # fx, fy, ...\n"
    "non_svp_model: FLATPORT\n"
    "non_svp_parameters: [0, 0, 1, 0.0253, 0.014, 1, 1.52, 1.334]\n"
    "width: 1920\n"
    "height: 1080\n";

TEST_F(Calibmar, ReadsAFlatPort) {
  const ColmapCamera camera = read_calibmar(written(kFlat));
  EXPECT_EQ(camera.model, "OPENCV");
  EXPECT_EQ(camera.width, 1920u);
  EXPECT_EQ(camera.height, 1080u);
  EXPECT_THAT(camera.params, ElementsAre(1200.5, 1201, 960, 540.25, -0.1, 0.02, 1e-4, -2e-4));
  const auto port = std::get<refractive::FlatPort<double>>(camera.port.value());
  EXPECT_EQ(port.normal, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(port.distance, 0.0253);
  EXPECT_EQ(port.thickness, 0.014);
  EXPECT_EQ(port.n_air, 1);
  EXPECT_EQ(port.n_glass, 1.52);
  EXPECT_EQ(port.n_water, 1.334);
}

// Other notations of YAML lists, another order of keys, the pose of a stereo camera, no newline at
// the end.
TEST_F(Calibmar, ReadsADomeWrittenInOtherWords) {
  const ColmapCamera camera = read_calibmar(
      written("---\nheight: 768\nwidth: 1024\n"
              "cam_to_world_rotation_rowmajor: [1, 0, 0,\n  0, 1, 0, 0, 0, 1]\n"
              "cam_to_world_translation:\n- 0.1\n- 0\n- 0\n"
              "model: \"PINHOLE\"\nparameters:\n  - 610\n  - 615.5\n  - 512\n  - 384\n"
              "non_svp_model: DOMEPORT\r\nnon_svp_parameters: [0.001, 0, -0.002, 0.05,\n"
              "  0.007, 1, 1.49, 1.333]"));
  EXPECT_THAT(camera.params, ElementsAre(610, 615.5, 512, 384));
  const auto port = std::get<refractive::DomePort<double>>(camera.port.value());
  EXPECT_EQ(port.centre, Eigen::Vector3d(0.001, 0, -0.002));
  EXPECT_EQ(port.inner_radius, 0.05);
}

TEST_F(Calibmar, ReadsACameraInAir) {
  const std::string air = "model: PINHOLE\nparameters: [9, 9, 4, 3]\nwidth: 8\nheight: 6\n";
  EXPECT_FALSE(read_calibmar(written(air)).port);
  EXPECT_FALSE(read_calibmar(written(air + "non_svp_model: NONE\n")).port);
}

TEST_F(Calibmar, IsAHousingWithoutPortsWhereItSaysSo) {
  const std::string air = "model: PINHOLE\nparameters: [9, 9, 4, 3]\nwidth: 8\nheight: 6\n";
  for (const char* none : {"non_svp_model: NONE\n", "non_svp_model: NONE\nnon_svp_parameters: []\n",
                           "non_svp_model: \"NONE\"\n", "non_svp_model:\n"}) {
    const Housing housing = read_housing(written(air + none));
    EXPECT_TRUE(housing.ports.empty()) << none;
    EXPECT_EQ(housing.port_of("any.jpg", 1), "none") << none;
  }
  EXPECT_THROW(read_housing(written(air)), Error);
  EXPECT_THROW(read_housing(written(air + "non_svp_model: CUBE\n")), Error);
}

TEST_F(Calibmar, ReadsWhatItWrites) {
  for (const bool dome : {false, true}) {
    ColmapCamera camera{
        1, "OPENCV", 1024, 768, {620.1, 1. / 3, 512, 384, -0.12, 0.02, 1e-17, -2e-4}};
    if (dome)
      camera.port.emplace(
          refractive::DomePort<double>{{0.1 / 3, 0, 0}, 0.05, 0.007, 1.0003, 1.49, 1.3});
    else
      camera.port.emplace(refractive::FlatPort<double>{Eigen::Vector3d(0.1, -0.2, 1).normalized(),
                                                       1. / 7, 0.01, 1.0, 1.49, 1.334});
    const std::vector<std::string> comments{"distance 25 +- 0.1 mm", "RMS 0.2 px"};
    write_calibmar(folder_ / "out.yaml", camera, comments);
    const std::string first = read_file(folder_ / "out.yaml");
    EXPECT_TRUE(first.starts_with("# distance 25 +- 0.1 mm\n# RMS 0.2 px\nmodel: OPENCV\n"))
        << first;
    const ColmapCamera again = read_calibmar(folder_ / "out.yaml");
    EXPECT_EQ(again.params, camera.params);
    write_calibmar(folder_ / "out.yaml", again, comments);
    EXPECT_EQ(read_file(folder_ / "out.yaml"), first);
  }
}

TEST_F(Calibmar, IsAFileOfLensesAndAHousing) {
  const std::filesystem::path file = written(kFlat);
  const std::vector<ColmapCamera> cameras = read_colmap_cameras(file);
  ASSERT_EQ(cameras.size(), 1u);
  EXPECT_EQ(cameras[0].params, read_calibmar(file).params);
  const Housing housing = read_housing(file);
  const auto port = std::get<refractive::FlatPort<double>>(
      housing.carried_port(housing.port_of("any.jpg", 7)).value());
  EXPECT_EQ(port.distance, 0.0253);
  EXPECT_EQ(port.n_water, 1.334);
}

TEST_F(Calibmar, AHousingNeedsAPort) {
  const std::string air = "model: PINHOLE\nparameters: [1, 1, 1, 1]\nwidth: 4\nheight: 4\n";
  EXPECT_THAT(test::error_of([&] { read_housing(written(air)); }),
              ::testing::EndsWith("key 'non_svp_model' is missing"));
}

TEST_F(Calibmar, WrongFilesAreNamed) {
  const auto without = [](const std::string& key) {
    const std::size_t begin = kFlat.find("\n" + key + ":") + 1;
    return kFlat.substr(0, begin) + kFlat.substr(kFlat.find('\n', begin) + 1);
  };
  for (const char* key : {"model", "parameters", "width", "height", "non_svp_parameters"})
    EXPECT_THAT(error_of(without(key)),
                HasSubstr("calibration.yaml: key '" + std::string(key) + "' is missing"));
  EXPECT_THAT(error_of(kFlat + "width: 3\n"), HasSubstr("line 8: key 'width' occurs twice"));
  EXPECT_THAT(error_of(kFlat.substr(0, kFlat.find(", 540"))), HasSubstr("truncated"));
  const auto with = [](const std::string& old, const std::string& now) {
    return test::replaced(kFlat, old, now);
  };
  EXPECT_THAT(error_of(with("FLATPORT", "PORTHOLE")), HasSubstr("'PORTHOLE' is not FLATPORT"));
  EXPECT_THAT(error_of("model: PINHOLE\nparameters: [9, 9, 4, 3]\nwidth: 8\nheight: 6\n"
                       "non_svp_model: none\nnon_svp_parameters: []\n"),
              HasSubstr("non_svp_model: the port 'none' is not FLATPORT"));
  EXPECT_THAT(error_of(with("0.0253", "x")), HasSubstr("non_svp_parameters has 'x'"));
  EXPECT_THAT(error_of(with("0.0253, ", "")), HasSubstr("has 7 numbers, expected 8"));
  EXPECT_THAT(error_of(with("0, 0, 1, ", "0, 0, -1, ")), HasSubstr("points backwards"));
  EXPECT_THAT(error_of(with("1920", "1920.5")), HasSubstr("width has '1920.5'"));
  EXPECT_THAT(error_of(with("1920", "[1, 2]")), HasSubstr("width has 2 numbers"));
  EXPECT_THAT(error_of(with("1920", "{a: 2}")), HasSubstr("width has 0 numbers"));
  EXPECT_THAT(error_of(with("960, ", "960, [540.25], ")), HasSubstr("parameters has '[...]'"));
  EXPECT_THAT(error_of("- model: PINHOLE\n"), HasSubstr("line 1: a list instead of 'key: value'"));
  EXPECT_THAT(error_of(with("OPENCV", "LENS")), HasSubstr("unknown model 'LENS'"));
  EXPECT_THAT(error_of(with("960, ", "")), HasSubstr("has 7 parameters, expected 8"));
  EXPECT_THAT(error_of("hello\n"), HasSubstr("line 1: 'hello' is not 'key: value'"));
  EXPECT_THAT(error_of(""), HasSubstr("is missing"));
}

}  // namespace
}  // namespace axial::io
