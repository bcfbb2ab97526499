// SPDX-License-Identifier: GPL-3.0-or-later
// Tests the program SimulateUnderwater from the command line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "base/atomic_file.h"
#include "base/error.h"
#include "io/bytes/json.h"
#include "io/cameras/housing.h"
#include "io/cameras/photograph_numbers.h"
#include "io/colmap/colmap.h"
#include "io/images/image.h"
#include "io/ply/ply.h"
#include "support/program_run.h"

namespace axial {
namespace {

namespace fs = std::filesystem;

using test::Outcome;

class SimulateUnderwater : public test::ProgramTest {
 protected:
  Outcome run(const std::string& arguments) const {
    return run_program("SimulateUnderwater", arguments);
  }

  void refuses(const std::string& expected, const std::string& arguments) const {
    expect_refusal("SimulateUnderwater", arguments, expected);
  }
};

const std::string kSmall =
    "--preset closeup --coarseness 4 --views 3 --width 96 --height 72 --samples 1 "
    "--process-priority 0 ";

const std::string kPort = "--port-distance 0.05 --tilt-degrees 0 --n-glass 1.6 --noise 0 ";

TEST_F(SimulateUnderwater, PhotographsThroughADome) {
  const std::string dome = "--dome-radius 0.06 --dome-x 0.004 --dome-z=-0.01 --n-glass 1.6 ";
  const Outcome outcome = run(kSmall + dome + "-o a --medium water");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const io::Housing housing = io::read_housing(folder_ / "a" / "housing.json");
  const auto& port = std::get<refractive::DomePort<double>>(housing.ports.at("main"));
  EXPECT_EQ(port.centre, Eigen::Vector3d(0.004, 0, -0.01));
  EXPECT_EQ(port.inner_radius, 0.06);
  EXPECT_EQ(port.n_glass, 1.6);
  refuses("--tilt-degrees", kSmall + dome + "--tilt-degrees 3 -o b");
  refuses("--dome-x needs --dome-radius", kSmall + "--dome-x 0.004 -o b");
  refuses("centre is 0.07", kSmall + "--dome-radius 0.06 --dome-x 0.07 -o b");
}

TEST_F(SimulateUnderwater, PhotographsOfTwoCameras) {
  const Outcome outcome =
      run(kSmall + "--rig-base 0.1 --rig-port-distance 0.025 -o a --medium water --truth 0");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const io::Housing housing = io::read_housing(folder_ / "a" / "housing.json");
  const io::ColmapModel model = io::read_colmap_model(folder_ / "a" / "sparse");
  ASSERT_EQ(model.cameras.size(), 2u);
  ASSERT_EQ(model.images.size(), 6u);
  for (const io::ColmapImage& image : model.images) {
    EXPECT_TRUE(fs::exists(folder_ / "a" / "water" / image.name)) << image.name;
    const std::string side = image.name.substr(0, image.name.find('/'));
    EXPECT_EQ(housing.port_of(image.name, image.camera), side);
    const auto& port = std::get<refractive::FlatPort<double>>(housing.ports.at(side));
    EXPECT_EQ(port.distance == 0.025, side == "right");
  }
  refuses("--rig-delay needs --rig-base", kSmall + "--rig-delay 0.1 -o b");
}

TEST_F(SimulateUnderwater, PhotographsWithTheLightOfWater) {
  write_atomically(folder_ / "lamps.json",
                   R"({"lamps": [{"place": [0.2, 0, 0], "direction": [0, 0, 1]}]})");
  const Outcome outcome = run(kSmall +
                              "--medium water --water 3C --light lamp:lamps.json "
                              "--exposure-stops 1 -o a");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_TRUE(fs::exists(folder_ / "a/water/0002.jpg"));
  EXPECT_TRUE(fs::exists(folder_ / "a/water/0002.albedo.tiff"));
  const nlohmann::json light = io::read_json(folder_ / "a/water/light.json");
  EXPECT_EQ(light.at("type"), "3C");
  EXPECT_EQ(light.at("lamps").at(0).at("place").at(0), 0.2);
  EXPECT_EQ(light.at("absorption_per_m").size(), 16u);
  EXPECT_EQ(light.at("exposures").size(), 3u);
  const io::PhotographNumbers exposures =
      io::read_photograph_numbers(folder_ / "a/water/exposures.csv", "exposure");
  for (const auto& [name, exposure] : exposures) EXPECT_NEAR(exposure, 1.25, 0.75) << name;
  EXPECT_NEAR(exposures.at("0002.jpg"), light.at("exposures").at(2), 1e-6);
  // A lamp beside the camera casts shadows, and most of the surface is lit.
  double least = 0, most = 0;
  const cv::Mat lit =
      cv::imread((folder_ / "a/water/0002.lit.tiff").string(), cv::IMREAD_UNCHANGED);
  cv::minMaxLoc(lit, &least, &most);
  EXPECT_GE(least, 0);
  EXPECT_LT(least, 0.9);
  EXPECT_EQ(most, 1);
  EXPECT_GT(cv::mean(lit)[0], 0.7);
  refuses("water is '3X'", kSmall + "--water 3X -o b");
  refuses("must be a type of water, or nine numbers", kSmall + "--water 1,2 -o b");
  refuses("'30' is not a number from 0 to 20", kSmall + "--water 30,1,1,1,1,1,0,0,0 -o b");
  refuses("--light is 'moon'", kSmall + "--water 3C --light moon -o b");
  refuses("--exposure-stops needs --water", kSmall + "--exposure-stops 1 -o b");
  refuses("--depth needs --water", kSmall + "--depth 3 -o b");
  refuses("--depth 0.1: must be above", kSmall + "--water 3C --depth 0.1 -o b");
  refuses("--light contradicts --water with nine numbers",
          kSmall + "--water 1,1,1,1,1,1,0,0,0 --light lamp -o b");
  refuses("--haze contradicts --water", kSmall + "--water 3C --haze 0.5 -o b");
  write_atomically(folder_ / "dark.json",
                   R"({"lamps": [{"place": [0.2, 0], "direction": [0, 0, 1]}]})");
  refuses("dark.json: lamps[0].place is [0.2,0], expected 3 numbers",
          kSmall + "--water 3C --light lamp:dark.json -o b");
}

TEST_F(SimulateUnderwater, PhotographsThroughTheSurface) {
  const Outcome outcome = run(kSmall + "--water-level 0.5 --n-water 1.34 -o a --medium water");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const io::Housing housing = io::read_housing(folder_ / "a" / "housing.json");
  const auto& surface = std::get<WaterSurface>(housing.ports.at("main"));
  EXPECT_EQ(surface.normal, Eigen::Vector3d(0, 0, -1));
  EXPECT_EQ(surface.point.z(), 0.5);
  EXPECT_EQ(surface.n_water, 1.34);
  refuses("--tilt-degrees is for a housing", kSmall + "--water-level 0.5 --tilt-degrees 3 -o b");
  refuses("--dome-radius is for a housing", kSmall + "--water-level 0.5 --dome-radius 0.1 -o b");
  refuses("view 0: the camera is -", kSmall + "--water-level 5 -o b");
  refuses("surface is at a height of 0 m, but the scene reaches", kSmall + "--water-level 0 -o b");
}

TEST_F(SimulateUnderwater, WritesAWholeSceneAndItsTruthAgain) {
  const Outcome outcome = run(kSmall + kPort + "-o a --max-threads 1");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const fs::path scene = folder_ / "a";
  const io::ColmapModel model = io::read_colmap_model(scene / "sparse");
  ASSERT_EQ(model.images.size(), 3u);
  EXPECT_GT(model.points.size(), 100u);
  EXPECT_GT(io::read_mesh_ply(scene / "mesh.ply").faces.size(), 1000u);
  const io::Housing housing = io::read_housing(scene / "housing.json");
  const auto& port = std::get<refractive::FlatPort<double>>(housing.ports.at("main"));
  EXPECT_EQ(port.distance, 0.05);
  EXPECT_EQ(port.n_glass, 1.6);
  EXPECT_EQ(port.normal, Eigen::Vector3d::UnitZ());
  for (const std::string medium : {"air", "water"}) {
    for (const io::ColmapImage& image : model.images) {
      const fs::path base = (scene / medium / image.name).replace_extension();
      EXPECT_EQ(io::read_color_image(base.string() + ".jpg").size(), cv::Size(96, 72));
      const cv::Mat1f distance = io::read_float_tiff(base.string() + ".distance.tiff");
      const cv::Mat3f normal = cv::imread(base.string() + ".normal.tiff", cv::IMREAD_UNCHANGED);
      EXPECT_GT(*std::min_element(distance.begin(), distance.end()), 0.3f);
      EXPECT_NEAR(cv::norm(normal(40, 40)), 1, 1e-5);
      // The channels of the file are x, y, z, which OpenCV reads as z, y, x: on average a floor
      // points upwards in the world.
      EXPECT_GT(cv::mean(normal)[0], 0.5);
    }
  }

  // The truth of one medium only, with another number of threads: identical bytes and no other
  // files.
  const Outcome again = run(kSmall + kPort + "-o b --max-threads 2 --truth-only --medium water");
  ASSERT_EQ(again.exit_code, 0) << again.output;
  std::size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / "b")) {
    if (!entry.is_regular_file()) continue;
    const fs::path name = fs::relative(entry.path(), folder_ / "b");
    EXPECT_EQ(read_file(entry.path()), read_file(scene / name)) << name;
    ++files;
  }
  EXPECT_EQ(files, 1u + 3 * 2);  // the mesh; three views, two kinds
}

TEST_F(SimulateUnderwater, PhotographsThroughHaze) {
  const auto contrast = [&](const std::string& haze) {
    const Outcome outcome = run(kSmall + haze + " --noise 0 --medium water -o " + haze.substr(7));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    const cv::Mat3b image = io::read_color_image(folder_ / haze.substr(7) / "water" / "0000.jpg");
    cv::Scalar mean, deviation;
    cv::meanStdDev(image, mean, deviation);
    return deviation[1];
  };
  const double clear = contrast("--haze 0");
  EXPECT_GT(clear, 10);
  const double hazy = contrast("--haze 0.75");
  EXPECT_LT(hazy, 0.5 * clear);
  EXPECT_GT(hazy, 0.05 * clear);
}

TEST_F(SimulateUnderwater, PhotographsASecondSurveyWithOtherNoise) {
  const std::string reef =
      "--coarseness 8 --views 2 --width 64 --height 48 --samples 1 --truth 0 --medium water ";
  const auto noise_of = [&](const std::string& name, const std::string& option) {
    const std::string all = reef + "--jpeg-quality 100 --haze 1 " + option;
    const Outcome outcome = run(all + "-o " + name);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    return io::read_color_image(folder_ / name / "water" / "0000.jpg");
  };
  // The haze hides the scene.
  const cv::Mat3b first = noise_of("a", ""), second = noise_of("b", "--changed ");
  EXPECT_EQ(cv::norm(first, noise_of("c", "")), 0);
  EXPECT_GT(cv::norm(first, second), 0);
  const nlohmann::json change = io::read_json(folder_ / "b" / "change.json");
  EXPECT_FALSE(fs::exists(folder_ / "a" / "change.json"));
  EXPECT_NEAR(change["net"].get<double>(),
              change["came"].get<double>() - change["gone"].get<double>(), 1e-12);
  EXPECT_EQ(change["came"].get<double>(), change["boulder_came"]["volume"].get<double>() +
                                              change["patch_came"]["volume"].get<double>());
  const auto plates_of = [&](const std::string& name, const std::string& option) {
    EXPECT_EQ(run(reef + option + "--targets 3 --bars 0.5 -o " + name).exit_code, 0);
    return io::read_json(folder_ / name / "true_targets.json")["plates"];
  };
  EXPECT_EQ(plates_of("e", ""), plates_of("f", "--changed "));
  refuses("only reef has one", "-o d --preset sand --changed");
  refuses("no boulder that can be moved", "-o d --preset reef --seed 46 --changed");
}

TEST_F(SimulateUnderwater, RefusesWrongOptionsInOneLine) {
  refuses("no output folder", "--preset reef");
  refuses("preset 'lake' is unknown", "-o a --preset lake");
  refuses("number of views is -2", "-o a --views -2");
  refuses("width is 0", "-o a --width 0");
  refuses("--samples 0: must be", "-o a --samples 0");
  refuses("--noise -1: must be", "-o a --noise -1");
  refuses("--haze 1.5: must be", "-o a --haze 1.5");
  refuses("--jpeg-quality 101: must be", "-o a --jpeg-quality 101");
  refuses("--medium fog: must be", "-o a --medium fog");
  refuses("--tilt-degrees 80: must be", "-o a --tilt-degrees 80");
  refuses("port distance is 2", "-o a --port-distance 2");
  refuses("refractive index is 0.5", "-o a --n-water 0.5");
  refuses("refractive index is nan", "-o a --n-glass nan");
  refuses("port does not cover", "-o a --tilt-degrees 45");
  refuses("unrecognised option", "-o a --nonsense 1");
  refuses("cannot be created", kSmall + "-o /proc/none --medium air --truth-only");
}

}  // namespace
}  // namespace axial
