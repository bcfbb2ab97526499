// SPDX-License-Identifier: GPL-3.0-or-later
// JSON files of cameras, and Calibmar's calibration.yaml.
#include <array>

#include "io/cameras/geo_offset.h"
#include "io/cameras/housing.h"
#include "io/cameras/lenses.h"
#include "io/colmap/calibmar.h"
#include "reader.h"

namespace axial::fuzz {
namespace {

refractive::FlatPort<double> flat_port() {
  return {{0, 0.6, 0.8}, 0.02, 0.01, 1, 1.5, 1.33};
}

refractive::DomePort<double> dome_port() {
  return {{0.001, 0, 0.002}, 0.05, 0.007, 1, 1.5, 1.33};
}

void read_housing_file(const fs::path& file) {
  read_and_copy(
      file,
      [](const fs::path& path) {
        return io::read_housing(path, io::PortValues::checked, dropping_lines());
      },
      io::write_housing);
}

bool write_housing_seed(const fs::path& file, int variant) {
  io::Housing housing = io::housing_with(flat_port());
  if (variant == 0) housing.ports["dome"] = dome_port();
  if (variant == 0) housing.ports["surface"] = WaterSurface{};
  if (variant == 0)
    housing.sigmas["main"] = {.normal_degrees = Eigen::Vector2d(1, 2), .index = 0.01};
  if (variant == 0) housing.sigmas["dome"].centre = Eigen::Vector3d(0.001, 0.002, 0.003);
  if (variant == 0) housing.cameras = {{7, "dome"}, {8, "none"}};
  if (variant == 0) housing.images = {{"a/b.png", "surface"}};
  io::write_housing(file, housing);
  return variant < 2;
}

void read_lenses_file(const fs::path& file) {
  read_and_copy(file, io::read_lenses, io::write_lenses);
}

bool write_lenses_seed(const fs::path& file, int variant) {
  io::SceneLenses lenses;
  if (variant == 0) {
    refractive::LensDistortion<double>& lens = lenses.lenses["wide"];
    lens.fisheye = 1;
    lens.above[1] = -0.1;
    lens.below[2] = 0.01;
    lens.p2 = 1e-3;
    lenses.lenses["other"].prism.x() = 1e-4;
    lenses.default_lens = "wide";
    lenses.images = {{"b.png", "other"}, {"c.png", "none"}};
  }
  io::write_lenses(file, lenses);
  return variant < 2;
}

fs::path scene_of(const fs::path& geo_file) {
  return geo_file.parent_path() / "scene.mvs";
}

void read_geo_file(const fs::path& file) {
  const auto read = [](const fs::path& path) { return io::read_geo_offset_beside(scene_of(path)); };
  const std::optional<LocalFrame> frame = read(file);
  if (!frame || frame->is_world()) return;
  const auto again = read_copy(frame, file, read, [](const fs::path& path, const auto& value) {
    io::write_geo_offset_beside(scene_of(path), *value);
  });
  require(again && again->origin == frame->origin, "the copy has another origin");
}

bool write_geo_seed(const fs::path& file, int variant) {
  io::write_geo_offset_beside(scene_of(file), {{500000.25, -4649776.5, 1e-3}});
  return variant < 1;
}

void read_calibmar_file(const fs::path& file) {
  io::says_no_port(file);
  const auto read = [](const fs::path& path) { return io::read_calibmar(path, dropping_lines()); };
  read_and_copy(file, read, [](const fs::path& path, const io::ColmapCamera& camera) {
    io::write_calibmar(path, camera);
  });
}

bool write_calibmar_seed(const fs::path& file, int variant) {
  const std::string comment = "made for a test";
  io::ColmapCamera camera{1, "OPENCV", 640, 480, {500, 510, 320.5, 240.5, -0.1, 0.01, 1e-3, 2e-3}};
  if (variant == 0) camera.port = flat_port();
  if (variant == 1) camera.port = dome_port();
  io::write_calibmar(file, camera, {&comment, 1});
  if (variant == 3)
    write_atomically(file,
                     "---\n'model': SIMPLE_RADIAL # lens\nparameters:\n- 500\n- 320\n- 240\n"
                     "- -1e-1\nwidth: 640\nheight: 480\nnon_svp_model: NONE\n"
                     "pose: [1,\n  2]\n...\n");
  return variant < 4;
}

}  // namespace

std::span<const Reader> camera_readers() {
  static constexpr std::array kReaders{
      Reader{"housing", "scene.housing.json", read_housing_file, write_housing_seed},
      Reader{"lenses", "scene.lenses.json", read_lenses_file, write_lenses_seed},
      Reader{"geo-offset", "scene.geo.json", read_geo_file, write_geo_seed},
      Reader{"calibmar", "calibration.yaml", read_calibmar_file, write_calibmar_seed}};
  return kReaders;
}

}  // namespace axial::fuzz
