// SPDX-License-Identifier: GPL-3.0-or-later
// COLMAP itself reads models that are written for COLMAP.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/subprocess.h"
#include "io/colmap/colmap.h"
#include "io/same_colmap.h"
#include "support/empty_folder.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;

bool colmap_is_there() {
  return std::system("command -v colmap >/dev/null") == 0;
}

ColmapCamera camera(std::uint32_t id, const std::string& model, std::vector<double> params) {
  return {id, model, 1024, 768, std::move(params)};
}

// Two images that see three points, with the lens models that RefinePoses accepts, and with ports,
// which COLMAP does not know.
ColmapModel small_model() {
  ColmapModel model;
  model.cameras = {camera(1, "OPENCV", {801.5, 800.25, 512, 384, 0.01, -0.02, 1e-3, -1e-3}),
                   camera(2, "OPENCV_FISHEYE", {700, 701, 511.5, 383.25, 0.1, 0.01, 0, -0.001}),
                   camera(3, "PINHOLE", {900, 901, 512.5, 384.5})};
  model.cameras[0].port = refractive::FlatPort<double>{{0, 0, 1}, 0.02, 0.014, 1, 1.52, 1.333};
  model.cameras[1].port = refractive::DomePort<double>{{0, 0, 0.01}, 0.1};
  for (const std::uint32_t id : {1u, 2u, 7u}) {
    ColmapImage image;
    image.id = id;
    image.camera = id == 7 ? 3 : id;
    image.name = "folder/image" + std::to_string(id) + ".jpg";
    image.pose.rotation =
        Eigen::AngleAxisd(0.1 * id, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    image.pose.centre = {0.1 * id, -0.25, 1e-3 * id};
    for (std::uint32_t k = 0; k < 4; ++k)
      image.points.push_back({100.5 + 50 * k, 200.125 + id, k < 3 ? 10 * k + 5 : kNoPoint3D});
    model.images.push_back(image);
  }
  for (std::uint32_t k = 0; k < 3; ++k)
    model.points.push_back({10 * k + 5,
                            {0.1 * k, 0.2, 3.0 + k},
                            {static_cast<std::uint8_t>(40 * k), 7, 255},
                            0.25 * k,
                            {{1, k}, {2, k}, {7, k}}});
  return model;
}

// COLMAP may write cameras, images and points in another order. Those of small_model() are in the
// order of their ids.
ColmapModel sorted(ColmapModel model) {
  std::ranges::sort(model.cameras, {}, &ColmapCamera::id);
  std::ranges::sort(model.images, {}, &ColmapImage::id);
  std::ranges::sort(model.points, {}, &ColmapPoint3D::id);
  return model;
}

// Writes the model in one form, lets COLMAP convert it to the other, and compares.
void expect_colmap_reads(bool text) {
  const fs::path folder = test::empty_folder();
  const ColmapModel model = small_model();
  make_folder(folder / "ours");
  make_folder(folder / "theirs");
  (text ? write_colmap_text : write_colmap_binary)(folder / "ours", model);
  run_subprocess({"colmap", "model_converter", "--input_path", folder / "ours", "--output_path",
                  folder / "theirs", "--output_type", text ? "BIN" : "TXT"},
                 folder / "log");
  const ColmapModel theirs = sorted(read_colmap_model(folder / "theirs"));
  test::expect_same(theirs, model, 1e-12);
  for (const ColmapCamera& camera : theirs.cameras) EXPECT_FALSE(camera.port);
  fs::remove_all(folder);
}

TEST(ColmapItself, ReadsTextThatIsWrittenForIt) {
  if (!colmap_is_there()) GTEST_SKIP() << "COLMAP is not installed";
  expect_colmap_reads(true);
}

TEST(ColmapItself, ReadsBinaryFilesThatAreWrittenForIt) {
  if (!colmap_is_there()) GTEST_SKIP() << "COLMAP is not installed";
  expect_colmap_reads(false);
}

}  // namespace
}  // namespace axial::io
