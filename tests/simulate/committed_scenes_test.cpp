// SPDX-License-Identifier: GPL-3.0-or-later
// The current program must reproduce the scenes in data/synthetic from their seeds.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <opencv2/core.hpp>

#include "base/error.h"
#include "io/cameras/housing.h"
#include "io/colmap/colmap.h"
#include "io/images/image.h"
#include "simulate/presets/presets.h"
#include "simulate/solid_texture.h"
#include "support/empty_folder.h"

namespace axial::simulate {
namespace {

namespace fs = std::filesystem;

// The seed that the READMEs of the scenes name.
constexpr std::uint32_t kSeed = 1;
constexpr int kSamples = 3, kJpegQuality = 93;
constexpr double kNoise = 1.2;

fs::path folder_of(const std::string& name) {
  return fs::path(AXIAL_SOURCE_DIR) / "data" / "synthetic" / name;
}

struct Remade {
  explicit Remade(const std::string& name)
      : preset(make_preset({name, kSeed, 0, 1024, 768, 80})),
        mesh(terrain_mesh(preset.terrain)),
        scene(mesh) {}

  Preset preset;
  TriangleMesh mesh;
  RayScene scene;
};

void expect_same_model(const Preset& preset, const io::ColmapModel& model) {
  ASSERT_EQ(model.images.size(), preset.views.size());
  ASSERT_EQ(model.cameras.size(), 1u);
  EXPECT_NEAR(model.cameras[0].params[0], preset.lens.focal, 1e-9);
  EXPECT_NEAR(model.cameras[0].params[2], preset.lens.cx + 0.5, 1e-9);
  for (std::size_t i = 0; i < preset.views.size(); ++i) {
    const View& view = preset.views[i];
    // Poses are stored as quaternions and translations: a few roundings.
    EXPECT_LT((model.images[i].pose.rotation - view.rotation).norm(), 1e-12);
    EXPECT_LT((model.images[i].pose.centre - view.centre).norm(), 1e-12);
  }
}

// The committed points are ground truth, so the distances along the rays must agree with them.
void expect_same_distances(const Remade& remade, const io::ColmapModel& model, std::size_t image) {
  std::size_t off = 0, count = 0;
  for (const io::ColmapPoint2D& observation : model.images[image].points) {
    ASSERT_GE(observation.point3d, 1u);
    const io::ColmapPoint3D& point = model.points.at(observation.point3d - 1);
    ASSERT_EQ(point.id, observation.point3d);
    const View& view = remade.preset.views[image];
    const SceneRay ray = to_world(
        view, *trace_pixel(remade.preset.lens, nullptr, observation.x - 0.5, observation.y - 0.5));
    const auto hit = remade.scene.first_hit(ray.start, ray.direction);
    ASSERT_TRUE(hit);
    const double distance = (point.position - view.centre).norm();
    ++count;
    if (std::abs(hit->distance - distance) > 1e-5 * distance) ++off;
  }
  EXPECT_GT(count, 200u);
  // A point counts as visible if the surface in front of it is nearer by at most a thousandth of
  // the distance.
  EXPECT_LE(1000 * off, 5 * count) << off << " of " << count;
}

void expect_same_image(const Remade& remade, const std::string& name, std::size_t image,
                       bool water) {
  const Preset& preset = remade.preset;
  const Shader shader = seabed_shader(remade.mesh, remade.scene, preset.texture);
  const cv::Mat3f radiance =
      render_radiance(remade.scene, shader, preset.lens, water ? &preset.port : nullptr,
                      preset.views[image], kSamples);
  const fs::path folder = test::empty_folder();
  const fs::path file = folder / "remade.jpg";
  io::write_jpeg(file, develop(radiance, kNoise, noise_key(kSeed, image, water)), kJpegQuality);
  const fs::path committed =
      folder_of(name) / (water ? "water" : "air") / fmt::format("{:04}.jpg", image);
  EXPECT_GE(cv::PSNR(io::read_color_image(committed), io::read_color_image(file)), 45);
  fs::remove_all(folder);
}

void expect_same_port(const Port& port, const std::string& name) {
  const io::Housing housing = io::read_housing(folder_of(name) / "housing.json");
  const auto& stored =
      std::get<refractive::FlatPort<double>>(housing.ports.at(housing.default_port));
  EXPECT_LT((stored.normal - port.normal).norm(), 1e-12);
  EXPECT_EQ(stored.distance, port.distance);
  EXPECT_EQ(stored.thickness, port.thickness);
  EXPECT_EQ(stored.n_glass, port.n_glass);
  EXPECT_EQ(stored.n_water, port.n_water);
}

void remake(const std::string& name) {
  const Remade remade(name);
  const io::ColmapModel model = io::read_colmap_model(folder_of(name) / "sparse");
  expect_same_port(remade.preset.port, name);
  expect_same_model(remade.preset, model);
  for (std::size_t i = 0; i < model.images.size(); ++i) expect_same_distances(remade, model, i);
  expect_same_image(remade, name, 3, true);
}

TEST(CommittedScenes, ReefIsRemadeFromItsSeed) {
  remake("reef");
}
TEST(CommittedScenes, CloseupIsRemadeFromItsSeed) {
  remake("closeup");
}

}  // namespace
}  // namespace axial::simulate
