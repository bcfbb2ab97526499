// SPDX-License-Identifier: GPL-3.0-or-later
// Labels in photographs against the simulator, which traces each pixel with its own optics and its
// own search of the mesh.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "labels/fill.h"
#include "labels/map_to_photographs.h"
#include "simulate/presets/presets.h"
#include "simulate/ray_scene.h"

namespace axial::labels {
namespace {

struct World {
  explicit World(const std::string& name)
      : preset(simulate::make_preset({.name = name, .width = 200, .height = 150, .coarseness = 5})),
        terrain(simulate::terrain_mesh(preset.terrain)),
        scene(terrain) {
    mesh.vertices = terrain.vertices;
    mesh.faces = terrain.faces;
  }

  geometry::PosedCamera camera(const simulate::View& view) const {
    geometry::PosedCamera posed;
    posed.camera.width = preset.lens.width;
    posed.camera.height = preset.lens.height;
    posed.camera.lens.fx = posed.camera.lens.fy = preset.lens.focal;
    posed.camera.lens.cx = preset.lens.cx;
    posed.camera.lens.cy = preset.lens.cy;
    const simulate::Port& port = preset.port;
    posed.camera.port = refractive::FlatPort<double>{port.normal, port.distance, port.thickness,
                                                     port.n_air,  port.n_glass,  port.n_water};
    posed.pose.rotation = view.rotation;
    posed.pose.centre = view.centre;
    return posed;
  }

  // The place that a pixel shows.
  std::optional<Eigen::Vector3d> place_at(const simulate::View& view, int x, int y) const {
    const auto traced = simulate::trace_pixel(preset.lens, &preset.port, x, y);
    if (!traced) return std::nullopt;
    const simulate::SceneRay ray = simulate::to_world(view, *traced);
    const auto hit = scene.first_hit(ray.start, ray.direction);
    if (!hit) return std::nullopt;
    return ray.start + hit->distance * ray.direction;
  }

  simulate::Preset preset;
  simulate::TriangleMesh terrain;
  simulate::RayScene scene;
  Mesh mesh;
};

// A ring around `centre` with a hole.
map::Label ring_around(const Eigen::Vector2d& centre, double radius) {
  map::Label label{"ring", "ring", {{{}, {}}}, {}};
  for (int i = 0; i < 40; ++i) {
    const double angle = 2 * std::numbers::pi * i / 40;
    const Eigen::Vector2d way(std::cos(angle), std::sin(angle));
    label.parts[0][0].push_back(centre + radius * way);
    label.parts[0][1].push_back(centre + 0.4 * radius * way);
  }
  return label;
}

struct Comparison {
  int inside = 0, different = 0;
};

// All views, each pixel.
Comparison compare(const World& world, const map::Label& label) {
  const LabelledSurface surface(world.mesh, {}, {});
  const std::vector<map::Label> labels{label};
  const MapLabels placed(surface, labels);
  const geometry::PolygonPieces polygon(label.parts[0]);
  Comparison all;
  for (const simulate::View& view : world.preset.views) {
    cv::Mat1w mask(world.preset.lens.height, world.preset.lens.width, std::uint16_t{0});
    for (const SeenLabel& seen : placed.seen_in(PosedRays(world.camera(view))))
      fill(seen.label.parts, 1, mask);
    for (int y = 0; y < mask.rows; ++y)
      for (int x = 0; x < mask.cols; ++x) {
        const auto place = world.place_at(view, x, y);
        const bool expected = place && polygon.contains(place->head<2>());
        all.inside += expected;
        all.different += expected != (mask(y, x) == 1);
      }
  }
  return all;
}

// The worlds hide much of the ground and have overhangs. Pixels may differ where the outline passes
// their centre by some hundredths of a pixel, or where a piece is narrower than a pixel. Both
// optics and both searches of the mesh agree elsewhere.
TEST(MapLabels, AreThoseOfTheSimulator) {
  for (const char* name : {"thicket", "amphora"}) {
    const World world(name);
    const Comparison all = compare(world, ring_around({0.02, -0.03}, 0.25));
    EXPECT_GT(all.inside, 5000) << name;
    EXPECT_LT(all.different, 0.005 * all.inside)
        << name << ": " << all.different << " of " << all.inside;
  }
}

}  // namespace
}  // namespace axial::labels
