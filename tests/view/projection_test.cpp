// SPDX-License-Identifier: GPL-3.0-or-later
// The projection of the viewer, in JavaScript, against the cameras of refractive/.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/atomic_file.h"
#include "base/subprocess.h"
#include "io/bytes/json.h"
#include "refractive/lens_views.h"
#include "scene/any_camera.h"
#include "support/empty_folder.h"
#include "view/camera_data.h"

namespace axial::view {
namespace {

namespace rt = refractive::testing;
using Port = std::optional<refractive::Port<double>>;

// An image with the camera, at a random pose, and points that it sees.
nlohmann::ordered_json data_of(rt::Random& random, const rt::LensView& view, bool distorted,
                               const Port& port) {
  SceneImage image;
  image.camera = {view.width, view.height, view.lens, port, {}};
  if (distorted) image.camera.distortion = view.distortion;
  image.pose.rotation = Eigen::AngleAxisd(random.uniform(0, 3), random.unit_vector()).matrix();
  image.pose.centre = random.uniform(0, 5) * random.unit_vector();
  const AnyCamera<double> camera(make_camera<double>(image.camera));
  std::vector<Eigen::Vector3f> points;
  for (int k = 0; k < 40; ++k) {
    const refractive::AxialRay<double> ray =
        camera.ray({random.uniform(0, view.width - 1), random.uniform(0, view.height - 1)});
    points.push_back(image.pose.to_world(ray.at(random.log_uniform(0.4, 30))).cast<float>());
  }
  return camera_data(image, points);
}

nlohmann::ordered_json random_cameras() {
  rt::Random random(17);
  nlohmann::ordered_json cameras = nlohmann::ordered_json::array();
  for (int k = 0; k < 30; ++k) {
    const rt::LensView bare = rt::random_lens(random);
    const rt::LensFlatView flat = rt::random_flat_lens(random);
    const rt::LensDomeView dome = rt::random_dome_lens(random);
    cameras.push_back(data_of(random, bare, true, {}));
    cameras.push_back(data_of(random, flat, true, flat.port));
    cameras.push_back(data_of(random, dome, true, dome.port));
    if (bare.distortion.fisheye > 0) continue;  // a pinhole with this lens would be too wide
    cameras.push_back(data_of(random, bare, false, {}));
    cameras.push_back(data_of(random, bare, false, flat.port));
    cameras.push_back(data_of(random, bare, false, dome.port));
  }
  return cameras;
}

TEST(ProjectionInThePage, AgreesWithTheCameras) {
  if (std::system("node --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "no node";
  const std::filesystem::path folder = test::empty_folder();
  const nlohmann::ordered_json cameras = random_cameras();
  std::size_t checks = 0;
  for (const auto& camera : cameras) checks += camera["check"].size();
  EXPECT_GT(checks, 40 * cameras.size() * 9 / 10);
  write_atomically(folder / "cameras.json", io::to_text(cameras));
  // .mjs, because node takes a .js file for an ES module only if a package.json says so.
  std::filesystem::copy_file(
      std::filesystem::path(AXIAL_SOURCE_DIR) / "apps/ViewScene/page/src/project.js",
      folder / "project.mjs");
  std::ofstream(folder / "compare.mjs")
      << "import fs from 'node:fs';\n"
         "import { largestError } from './project.mjs';\n"
         "const cameras = JSON.parse(fs.readFileSync(process.argv[2]));\n"
         "console.log(Math.max(...cameras.map(largestError)));\n";
  run_subprocess({"node", (folder / "compare.mjs").string(), (folder / "cameras.json").string()},
                 folder / "log");
  const double error = std::stod(read_file(folder / "log"));
  rt::report("largest difference of the page's projection [px]", error);
  EXPECT_LT(error, 1e-6);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace axial::view
