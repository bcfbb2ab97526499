// SPDX-License-Identifier: GPL-3.0-or-later
// OpenMVS's interchange scenes.
#include "io/openmvs/mvs.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "io/openmvs/mvs_counts.h"
#include "openmvs/private/mvs_format.h"
#include "reader.h"

namespace axial::fuzz {
namespace {

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() &&
         (a.empty() || !std::memcmp(a.data(), b.data(), a.size() * sizeof(T)));
}

bool same_camera(const CameraModel& a, const CameraModel& b) {
  return a.width == b.width && a.height == b.height && a.lens.fx == b.lens.fx &&
         a.lens.fy == b.lens.fy && a.lens.cx == b.lens.cx && a.lens.cy == b.lens.cy;
}

bool same_image(const SceneImage& a, const SceneImage& b) {
  if (a.path != b.path || a.mask_path != b.mask_path || a.id != b.id ||
      a.calibrated != b.calibrated || a.min_depth != b.min_depth || a.max_depth != b.max_depth ||
      a.average_depth != b.average_depth || !same_bytes(a.neighbours, b.neighbours))
    return false;
  return !a.calibrated || (same_camera(a.camera, b.camera) && a.pose.centre == b.pose.centre &&
                           (a.pose.rotation - b.pose.rotation).cwiseAbs().maxCoeff() < 1e-9);
}

bool same_point(const SparsePoint& a, const SparsePoint& b) {
  return a.position == b.position && same_bytes(a.views, b.views);
}

// The centre of a small box far from the origin is rounded, and its sides may vanish.
bool is_wide(const std::optional<OrientedBox>& box) {
  return box && (box->half_extent.array() > 1e-9 * box->centre.cwiseAbs().array()).all();
}

bool same_scene(const Scene& a, const Scene& b) {
  return std::ranges::equal(a.images, b.images, same_image) &&
         std::ranges::equal(a.points, b.points, same_point) &&
         same_bytes(a.point_normals, b.point_normals) &&
         same_bytes(a.point_colors, b.point_colors) && (a.region.has_value() || !is_wide(b.region));
}

void read_scene(const fs::path& file) {
  const auto read = [](const fs::path& path) {
    return io::read_mvs(path, "/images", dropping_lines());
  };
  const Scene scene = read(file);
  // The writer refuses a scene without a calibrated image.
  if (std::ranges::none_of(scene.images, &SceneImage::calibrated)) return;
  const Scene again = read_copy(scene, file, read, [](const fs::path& path, const Scene& value) {
    io::write_mvs(path, value, "/images");
  });
  require(same_scene(again, scene), "the copy is another scene");
}

// A scene that can be read can be counted, and the counts agree.
void count_scene_file(const fs::path& file) {
  const auto counts = io::count_mvs(file);
  const Scene scene = io::read_mvs(file, "/images");
  if (!read_file(file).starts_with("MVSI")) return;
  require(counts.has_value(), "a scene that can be read cannot be counted");
  require(counts->images == scene.images.size(), "the number of images differs");
  require(counts->points == scene.points.size(), "the number of points differs");
  require(counts->normals == scene.point_normals.size(), "the number of normals differs");
}

Scene small_scene() {
  Scene scene;
  scene.images.resize(3);
  for (std::uint32_t i = 0; i < 3; ++i) {
    SceneImage& image = scene.images[i];
    image.path = "/images/" + std::to_string(i) + ".png";
    image.id = 40 + i;
    image.camera = {640, 480, {500, 510, 320, 240}, std::nullopt};
    image.pose.centre = {1.0 * i, 2, 3};
    image.calibrated = i < 2;
    image.neighbours = {{(i + 1) % 3, 12, 1.5f, 0.25f, 0.75f, 5}};
  }
  scene.images[0].mask_path = "/masks/0.png";
  scene.points = {{{1, 2, 3}, {{0, 0.5f}, {1, 0.25f}}}, {{4, 5, 6}, {}}};
  scene.point_normals = {{0, 0, 1}, {0, 1, 0}};
  scene.point_colors = {{1, 2, 3}, {4, 5, 6}};
  scene.region = OrientedBox{Eigen::Matrix3d::Identity(), {1, 2, 3}, {4, 5, 6}};
  return scene;
}

bool write_scene_seed(const fs::path& file, int variant) {
  Scene scene = small_scene();
  if (variant == 1) {
    scene.points.clear();
    scene.point_normals.clear();
    scene.point_colors.clear();
    scene.region.reset();
  }
  io::write_mvs(file, scene, "/images");
  return variant < 2;
}

}  // namespace

std::span<const Reader> mvs_readers() {
  static constexpr std::array kReaders{
      Reader{"mvs", "scene.mvs", read_scene, write_scene_seed},
      Reader{"mvs-counts", "scene.mvs", count_scene_file, write_scene_seed}};
  return kReaders;
}

}  // namespace axial::fuzz
