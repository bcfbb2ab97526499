// SPDX-License-Identifier: GPL-3.0-or-later
// COLMAP's binary and text models, each part as a reader of its own.
#include "io/colmap/colmap.h"

#include <algorithm>
#include <array>

#include "colmap/private/colmap_parts.h"
#include "colmap/private/rig_parts.h"
#include "reader.h"

namespace axial::fuzz {
namespace {

using io::ColmapModel;
using WriteModel = void (*)(const fs::path& folder, const ColmapModel& model);

// Reads one part of a model. It must be the same after it was written with `write` and read again.
template <class T>
void read_part(const fs::path& file, std::vector<T> (*read)(const fs::path&),
               std::vector<T> ColmapModel::*part, WriteModel write) {
  read_and_copy(file, read, [&](const fs::path& path, const std::vector<T>& values) {
    ColmapModel model;
    model.*part = values;
    write(path.parent_path(), model);
  });
}

// Points and images do not depend on the dialect. Cameras of COLMAP-Underwater may have ports.
WriteModel writer_of(const std::vector<io::ColmapCamera>& cameras, WriteModel colmap,
                     WriteModel underwater) {
  for (const io::ColmapCamera& camera : cameras)
    if (camera.port) return underwater;
  return colmap;
}

void read_cameras_bin(const fs::path& file) {
  const auto read = [](const fs::path& path) {
    return io::read_cameras_binary(path, dropping_lines());
  };
  read_part(file, +read, &ColmapModel::cameras,
            writer_of(read(file), io::write_colmap_binary, io::write_underwater_binary));
}

void read_cameras_txt(const fs::path& file) {
  const auto read = [](const fs::path& path) {
    return io::read_cameras_text(path, dropping_lines());
  };
  read_part(file, +read, &ColmapModel::cameras, io::write_underwater_text);
}

bool same_colmap_image(const io::ColmapImage& a, const io::ColmapImage& b) {
  const auto same_point = [](const io::ColmapPoint2D& p, const io::ColmapPoint2D& q) {
    return p.x == q.x && p.y == q.y && p.point3d == q.point3d;
  };
  return a.id == b.id && a.camera == b.camera && a.name == b.name &&
         std::ranges::equal(a.points, b.points, same_point) &&
         (a.pose.rotation - b.pose.rotation).cwiseAbs().maxCoeff() < 1e-9 &&
         (a.pose.centre - b.pose.centre).norm() <= 1e-9 * a.pose.centre.norm();
}

// The files hold quaternions and translations, which are rounded when they are written.
void read_images(const fs::path& file, std::vector<io::ColmapImage> (*read)(const fs::path&),
                 WriteModel write) {
  const auto images = read(file);
  const auto again = read_copy(
      images, file, read, [&](const fs::path& path, const std::vector<io::ColmapImage>& values) {
        write(path.parent_path(), {{}, values, {}});
      });
  require(std::ranges::equal(images, again, same_colmap_image), "the copy has other images");
}

void read_images_bin(const fs::path& file) {
  read_images(file, io::read_images_binary, io::write_colmap_binary);
}

void read_images_txt(const fs::path& file) {
  read_images(file, io::read_images_text, io::write_colmap_text);
}

void read_points_bin(const fs::path& file) {
  read_part(file, io::read_points_binary, &ColmapModel::points, io::write_colmap_binary);
}

void read_points_txt(const fs::path& file) {
  read_part(file, io::read_points_text, &ColmapModel::points, io::write_colmap_text);
}

ColmapModel model() {
  ColmapModel model;
  model.cameras = {{1, "PINHOLE", 640, 480, {500, 510, 320, 240}},
                   {5, "SIMPLE_RADIAL", 320, 240, {150, 160, 120, -0.1}},
                   {9, "OPENCV_FISHEYE", 64, 48, {50, 51, 32, 24, 0.1, 0.01, 0.001, 0}}};
  io::ColmapImage image{3, 5, "a/b c.png", {}, {{1.5, 2.25, 7}, {3, 4, io::kNoPoint3D}}};
  image.pose.centre = {1, 2, 3};
  model.images = {image, {4, 1, "b.png", {}, {}}};
  model.points = {{7, {1, 2, 3}, {10, 20, 30}, 0.5, {{3, 0}, {4, 0}}}, {8, {4, 5, 6}, {}, 0, {}}};
  return model;
}

ColmapModel model_under_water() {
  ColmapModel with_ports = model();
  with_ports.cameras[0].port =
      refractive::FlatPort<double>{{0, 0.6, 0.8}, 0.02, 0.01, 1, 1.5, 1.33};
  with_ports.cameras[1].port =
      refractive::DomePort<double>{{0.001, 0, 0.002}, 0.05, 0.007, 1, 1.5, 1.33};
  return with_ports;
}

// Three forms of the same model: of COLMAP, of COLMAP-Underwater, and without any record.
template <WriteModel colmap, WriteModel underwater>
bool write_model_seed(const fs::path& file, int variant) {
  const fs::path folder = file.parent_path();
  if (variant == 0) colmap(folder, model());
  if (variant == 1) underwater(folder, model_under_water());
  if (variant == 2) colmap(folder, {});
  return variant < 3;
}

// Reads rigs, whose poses are finite.
template <std::vector<io::Rig> (*read)(const fs::path&)>
void read_rigs_of(const fs::path& file) {
  for (const io::Rig& rig : read(file))
    for (const io::RigCamera& camera : rig.cameras)
      require(!camera.pose || camera.pose->centre.allFinite(), "a pose is not finite");
}

template <std::vector<io::RigFrame> (*read)(const fs::path&)>
void read_frames_of(const fs::path& file) {
  read(file);
}

bool write_rig_config_seed(const fs::path& file, int variant) {
  write_atomically(
      file,
      "[{\"cameras\": [{\"image_prefix\": \"a/\", \"ref_sensor\": true}, {\"image_prefix\": "
      "\"b/\", "
      "\"cam_from_rig_rotation\": [1, 0, 0, 0], \"cam_from_rig_translation\": [0.2, 0, 0], "
      "\"sigma_translation\": 0.001, \"sigma_rotation\": 0.1}]}]\n");
  return variant < 1;
}

bool write_rigs_seed(const fs::path& file, int variant) {
  write_atomically(file, "# rigs\n1 2 CAMERA 1 CAMERA 2 1 1 0 0 0 0.2 0 0\n2 1 CAMERA 3\n");
  return variant < 1;
}

bool write_frames_seed(const fs::path& file, int variant) {
  write_atomically(file, "# frames\n1 1 1 0 0 0 0 0 0 2 CAMERA 1 1 CAMERA 2 2\n");
  return variant < 1;
}

// One record: a rig of one camera, or a frame of one image.
bool write_rigs_bin_seed(const fs::path& file, int variant) {
  constexpr std::array<std::uint32_t, 6> kWords{1, 0, 7, 1, 0, 3};  // the count has two words
  write_atomically(file, {reinterpret_cast<const char*>(kWords.data()), sizeof kWords});
  return variant < 1;
}

bool write_frames_bin_seed(const fs::path& file, int variant) {
  constexpr std::array<std::uint32_t, 4> kStart{1, 0, 1, 7};
  constexpr std::array<double, 7> kPose{1, 0, 0, 0, 0, 0, 0};
  constexpr std::array<std::uint32_t, 5> kImages{1, 0, 3, 9, 0};
  std::string bytes(reinterpret_cast<const char*>(kStart.data()), sizeof kStart);
  bytes.append(reinterpret_cast<const char*>(kPose.data()), sizeof kPose);
  bytes.append(reinterpret_cast<const char*>(kImages.data()), sizeof kImages);
  write_atomically(file, bytes);
  return variant < 1;
}

}  // namespace

std::span<const Reader> colmap_readers() {
  constexpr auto kBinary = write_model_seed<io::write_colmap_binary, io::write_underwater_binary>;
  constexpr auto kText = write_model_seed<io::write_colmap_text, io::write_underwater_text>;
  static constexpr std::array kReaders{
      Reader{"colmap-cameras-bin", "cameras.bin", read_cameras_bin, kBinary},
      Reader{"colmap-images-bin", "images.bin", read_images_bin, kBinary},
      Reader{"colmap-points-bin", "points3D.bin", read_points_bin, kBinary},
      Reader{"colmap-cameras-txt", "cameras.txt", read_cameras_txt, kText},
      Reader{"colmap-images-txt", "images.txt", read_images_txt, kText},
      Reader{"colmap-points-txt", "points3D.txt", read_points_txt, kText},
      Reader{"colmap-rig-config", "rig_config.json", read_rigs_of<io::read_rig_config>,
             write_rig_config_seed},
      Reader{"colmap-rigs-bin", "rigs.bin", read_rigs_of<io::read_rigs_binary>,
             write_rigs_bin_seed},
      Reader{"colmap-rigs-txt", "rigs.txt", read_rigs_of<io::read_rigs_text>, write_rigs_seed},
      Reader{"colmap-frames-bin", "frames.bin", read_frames_of<io::read_frames_binary>,
             write_frames_bin_seed},
      Reader{"colmap-frames-txt", "frames.txt", read_frames_of<io::read_frames_text>,
             write_frames_seed}};
  return kReaders;
}

}  // namespace axial::fuzz
