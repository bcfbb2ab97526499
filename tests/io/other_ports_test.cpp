// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/colmap/other_ports.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/wrong_input.h"
#include "support/captured_events.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

refractive::FlatPort<double> flat(double distance) {
  return {{0, 0, 1}, distance, 0.014, 1, 1.52, 1.333};
}

ColmapModel two_cameras() {
  ColmapModel model;
  model.images = {{1, 1, "a.jpg", {}, {}}, {2, 1, "left/b.jpg", {}, {}}, {3, 2, "c.jpg", {}, {}}};
  return model;
}

// Names of ports do not matter, only the ports themselves.
TEST(OtherPort, IsFoundByWhatImagesLookThrough) {
  const ColmapModel model = two_cameras();
  Housing by_camera;
  by_camera.ports = {{"camera_1", flat(0.02)}, {"camera_2", flat(0.03)}};
  by_camera.cameras = {{1, "camera_1"}, {2, "camera_2"}};
  Housing by_image;
  by_image.ports = {{"near", flat(0.02)}, {"far", flat(0.03)}};
  by_image.default_port = "near";
  by_image.images = {{"c.jpg", "far"}};
  EXPECT_EQ(image_with_other_port(by_image, by_camera, model), "");
  by_image.images["b.jpg"] = "far";
  EXPECT_EQ(image_with_other_port(by_image, by_camera, model), "left/b.jpg");
  by_image.images["b.jpg"] = "none";
  EXPECT_EQ(image_with_other_port(by_image, by_camera, model), "left/b.jpg");
  // A camera without a port makes no statement.
  by_camera.cameras.erase(1);
  EXPECT_EQ(image_with_other_port(by_image, by_camera, model), "");
}

// Every number of every kind of port counts, and so does the kind.
TEST(SamePort, ComparesEveryNumber) {
  const refractive::FlatPort<double> flat_port = flat(0.02);
  const refractive::DomePort<double> dome{{0, 0, 0.002}, 0.05, 0.007, 1, 1.52, 1.333};
  const WaterSurface lake{{0, 0, -1}, {0, 0, 1}, 1, 1.333};
  const std::vector<HousingPort> kinds{flat_port, dome, lake};
  for (std::size_t i = 0; i < kinds.size(); ++i)
    for (std::size_t j = 0; j < kinds.size(); ++j) EXPECT_EQ(same_port(kinds[i], kinds[j]), i == j);
  for (double refractive::FlatPort<double>::*number :
       {&refractive::FlatPort<double>::distance, &refractive::FlatPort<double>::thickness,
        &refractive::FlatPort<double>::n_air, &refractive::FlatPort<double>::n_glass,
        &refractive::FlatPort<double>::n_water}) {
    auto other = flat_port;
    other.*number += 1e-10;
    EXPECT_TRUE(same_port(flat_port, other));
    other.*number += 1e-6;
    EXPECT_FALSE(same_port(flat_port, other));
  }
}

TEST(HousingBesideAScene, IsNamedWhereItDiffers) {
  const fs::path folder = test::empty_folder();
  const fs::path scene_path = folder / "scene.mvs", beside = folder / "scene.housing.json";
  Scene scene;
  scene.images.resize(2);
  scene.images[0].path = "images/a.jpg";
  scene.images[1].path = "images/b.jpg";
  const Housing taken = housing_with(flat(0.02));
  const auto said = [&](const fs::path& file) {
    test::CapturedEvents log;
    warn_of_housing_beside(scene, scene_path, taken, file, log.context);
    return log.lines;
  };
  const fs::path given = folder / "port.json";
  write_housing(given, taken);
  EXPECT_EQ(said(given), "") << "there is none";
  Housing renamed;
  renamed.ports["window"] = flat(0.02);
  renamed.images = {{"a.jpg", "window"}, {"b.jpg", "window"}};
  write_housing(beside, renamed);
  EXPECT_EQ(said(given), "");
  renamed.images["b.jpg"] = "none";
  write_housing(beside, renamed);
  EXPECT_THAT(said(given),
              HasSubstr(beside.string() + ": is not used (" + given.string() +
                        " is used instead), and its ports differ, first for images/b.jpg"));
  EXPECT_EQ(said(beside), "") << "it is the one that is used";
  test::put(beside, "{");
  EXPECT_THAT(said(given), HasSubstr("malformed JSON"));
  fs::remove_all(folder);
}

}  // namespace
}  // namespace axial::io
