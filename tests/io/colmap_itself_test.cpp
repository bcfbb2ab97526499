// SPDX-License-Identifier: GPL-3.0-or-later
// COLMAP itself reads models that are written for COLMAP.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/subprocess.h"
#include "io/colmap/colmap.h"
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

template <class T, class Key>
std::map<std::uint64_t, T> by_id(const std::vector<T>& list, Key key) {
  std::map<std::uint64_t, T> map;
  for (const T& item : list) map.emplace(item.*key, item);
  return map;
}

void expect_same_images(const ColmapModel& found, const ColmapModel& written) {
  const auto images = by_id(found.images, &ColmapImage::id);
  ASSERT_EQ(images.size(), written.images.size());
  for (const ColmapImage& image : written.images) {
    const ColmapImage& same = images.at(image.id);
    EXPECT_EQ(same.name, image.name);
    EXPECT_EQ(same.camera, image.camera);
    // The rotation was converted to a quaternion and back.
    EXPECT_LT((same.pose.rotation - image.pose.rotation).norm(), 1e-12);
    EXPECT_LT((same.pose.centre - image.pose.centre).norm(), 1e-12);
    ASSERT_EQ(same.points.size(), image.points.size());
    for (std::size_t k = 0; k < image.points.size(); ++k) {
      EXPECT_EQ(same.points[k].x, image.points[k].x);
      EXPECT_EQ(same.points[k].y, image.points[k].y);
      EXPECT_EQ(same.points[k].point3d, image.points[k].point3d);
    }
  }
}

void expect_same(const ColmapModel& found, const ColmapModel& written) {
  const auto cameras = by_id(found.cameras, &ColmapCamera::id);
  ASSERT_EQ(cameras.size(), written.cameras.size());
  for (const ColmapCamera& camera : written.cameras) {
    EXPECT_EQ(cameras.at(camera.id).model, camera.model);
    EXPECT_EQ(cameras.at(camera.id).params, camera.params);
    EXPECT_FALSE(cameras.at(camera.id).port);
  }
  expect_same_images(found, written);
  const auto points = by_id(found.points, &ColmapPoint3D::id);
  ASSERT_EQ(points.size(), written.points.size());
  for (const ColmapPoint3D& point : written.points) {
    EXPECT_EQ(points.at(point.id).position, point.position);
    EXPECT_EQ(points.at(point.id).color, point.color);
    const std::vector<ColmapTrackElement>& track = points.at(point.id).track;
    ASSERT_EQ(track.size(), point.track.size());
    for (std::size_t k = 0; k < track.size(); ++k) {
      EXPECT_EQ(track[k].image, point.track[k].image);
      EXPECT_EQ(track[k].point2d, point.track[k].point2d);
    }
  }
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
  expect_same(read_colmap_model(folder / "theirs"), model);
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
