// SPDX-License-Identifier: GPL-3.0-or-later
// Compares files of other programs with values decoded by an independent reader.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "base/atomic_file.h"
#include "io/colmap/colmap.h"
#include "io/images/image.h"
#include "io/openmvs/mvs.h"
#include "io/wrong_input.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
const fs::path kData = fs::path(AXIAL_SOURCE_DIR) / ".." / "shared" / "data";

std::size_t views_in(const Scene& scene) {
  std::size_t views = 0;
  for (const SparsePoint& point : scene.points) views += point.views.size();
  return views;
}

TEST(RealFiles, SceneOfVersion6) {
  const fs::path folder = kData / "openmvs-files";
  if (!fs::exists(folder / "scene_v6.mvs")) GTEST_SKIP() << "no scene_v6.mvs here";
  const Scene scene = read_mvs(folder / "scene_v6.mvs", folder);
  ASSERT_EQ(scene.images.size(), 4u);
  EXPECT_EQ(scene.points.size(), 2663u);
  EXPECT_EQ(views_in(scene), 7133u);
  EXPECT_EQ(scene.point_colors.size(), 2663u);
  EXPECT_FALSE(scene.region);
  const SceneImage& image = scene.images[0];
  EXPECT_EQ(fs::path(image.path).filename(), "00000.jpg");
  EXPECT_EQ(image.id, 0u);
  EXPECT_EQ(image.camera.width, 640);
  EXPECT_EQ(image.camera.height, 479);
  EXPECT_EQ(image.camera.lens.fx, 672.62);
  EXPECT_EQ(image.camera.lens.cx, 312.168);
  EXPECT_EQ(image.camera.lens.cy, 226.712);
  EXPECT_EQ(image.pose.rotation(0, 0), 0.9912319405687486);
  EXPECT_EQ(image.pose.rotation(1, 2), 0.8908481853019111);
  EXPECT_EQ(image.pose.centre.y(), 7.969889288882188);
  const SparsePoint& point = scene.points[0];
  EXPECT_EQ(point.position, Eigen::Vector3f(-2.1896801f, -0.5623310f, -0.3569380f));
  ASSERT_EQ(point.views.size(), 3u);
  EXPECT_EQ(point.views[2].image, 2u);
  EXPECT_EQ(scene.point_colors[0], (Rgb{55, 62, 12}));  // stored blue, green, red
  EXPECT_EQ(read_image_size(image.path), cv::Size(640, 479));
}

// Checks all conventions together: nearly every stored observation must project into the image.
TEST(RealFiles, SparsePointsProjectIntoTheirImages) {
  const fs::path folder = kData / "openmvs-files";
  if (!fs::exists(folder / "scene_v6.mvs")) GTEST_SKIP() << "no scene_v6.mvs here";
  const Scene scene = read_mvs(folder / "scene_v6.mvs", folder);
  int inside = 0;
  for (const SparsePoint& point : scene.points) {
    std::set<std::uint32_t> seen;
    for (const SparseView& view : point.views) {
      if (!seen.insert(view.image).second) continue;
      const SceneImage& image = scene.images[view.image];
      const Eigen::Vector3d x = image.pose.to_camera(point.position.cast<double>());
      if (x.z() <= 0) continue;
      const auto pixel = image.camera.lens.pixel(x);
      inside += pixel.x() >= -0.5 && pixel.y() >= -0.5 && pixel.x() < 639.5 && pixel.y() < 478.5;
    }
  }
  EXPECT_EQ(inside, 7035);  // of 7132
}

TEST(RealFiles, SceneOfVersion7) {
  const fs::path folder = kData / "openmvs-files";
  if (!fs::exists(folder / "scene_dense_v7.mvs")) GTEST_SKIP() << "no scene_dense_v7.mvs here";
  const Scene scene = read_mvs(folder / "scene_dense_v7.mvs", folder);
  ASSERT_EQ(scene.images.size(), 11u);
  EXPECT_EQ(scene.points.size(), 12683u);
  EXPECT_EQ(views_in(scene), 45518u);
  const SceneImage& image = scene.images[0];
  EXPECT_EQ(image.camera.width, 1416);
  EXPECT_EQ(image.camera.height, 1064);
  EXPECT_EQ(image.camera.lens.fx, 1492.6641714577406);
  EXPECT_EQ(image.camera.lens.cy, 562.2669694372267);
  EXPECT_FLOAT_EQ(image.average_depth, 8.141387f);
  for (const SceneImage& each : scene.images) EXPECT_EQ(each.neighbours.size(), 10u);
  const ViewScore& best = image.neighbours[0];
  EXPECT_EQ(best.image, 1u);
  EXPECT_EQ(best.points, 2110u);
  EXPECT_FLOAT_EQ(best.scale, 1.0651573f);
  EXPECT_FLOAT_EQ(best.angle, 0.1831226f);
  EXPECT_FLOAT_EQ(best.area, 0.5234375f);
  EXPECT_FLOAT_EQ(best.score, 1035.9496f);
  EXPECT_EQ(image.neighbours[1].points, 1705u);
  // That file has empty names and an identity transform, as our files do, so the bytes are the
  // same.
  const fs::path copy = test::empty_folder() / "copy.mvs";
  write_mvs(copy, scene, folder);
  EXPECT_TRUE(read_file(copy) == read_file(folder / "scene_dense_v7.mvs"));
  fs::remove_all(copy.parent_path());
}

TEST(RealFiles, ColmapModelOfTheFountain) {
  const fs::path folder = kData / "fountain-P11";
  if (!fs::exists(folder / "sparse")) GTEST_SKIP() << "no fountain-P11 here";
  const ColmapModel model = read_colmap_model(find_colmap_model(folder));
  ASSERT_EQ(model.cameras.size(), 1u);
  EXPECT_EQ(model.cameras[0].params, (std::vector<double>{2759.48, 2764.16, 1520.69, 1006.81}));
  ASSERT_EQ(model.images.size(), 11u);
  EXPECT_EQ(model.images[0].name, "0010.jpg");
  EXPECT_EQ(model.points.size(), 14792u);
  // The mean reprojection error over all tracks is below a pixel only if the conventions of poses,
  // centres and pixels all fit together.
  std::map<std::uint32_t, const ColmapImage*> by_id;
  for (const ColmapImage& image : model.images) by_id[image.id] = &image;
  const auto& k = model.cameras[0].params;
  double sum = 0;
  std::size_t count = 0;
  for (const ColmapPoint3D& point : model.points)
    for (const ColmapTrackElement& element : point.track) {
      const ColmapImage& image = *by_id.at(element.image);
      const ColmapPoint2D& seen = image.points.at(element.point2d);
      EXPECT_EQ(seen.point3d, point.id);
      const Eigen::Vector3d x = image.pose.to_camera(point.position);
      sum += std::hypot(k[0] * x.x() / x.z() + k[2] - seen.x, k[1] * x.y() / x.z() + k[3] - seen.y);
      ++count;
    }
  EXPECT_NEAR(static_cast<double>(count) / 14792, 4.7573688480259602, 1e-12);
  EXPECT_LT(sum / static_cast<double>(count), 1.0);
}

}  // namespace
}  // namespace axial::io
