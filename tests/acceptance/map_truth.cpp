// SPDX-License-Identifier: GPL-3.0-or-later
#include "map_truth.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "axial/scene.h"
#include "base/parallel.h"
#include "io/images/image.h"
#include "scene/any_camera.h"
#include "scene/bilinear.h"
#include "simulate/ray_scene.h"
#include "simulate/render.h"

namespace axial::map_check {
namespace {

// The exact camera of all photographs under water.
CameraModel camera_of(const simulate::Preset& preset) {
  const simulate::Lens& lens = preset.lens;
  const simulate::Port& port = preset.port;
  CameraModel camera;
  camera.width = lens.width, camera.height = lens.height;
  camera.lens = {lens.focal, lens.focal, lens.cx, lens.cy};
  camera.port = refractive::FlatPort<double>{port.normal, port.distance, port.thickness,
                                             port.n_air,  port.n_glass,  port.n_water};
  return camera;
}

class Photographers {
 public:
  explicit Photographers(const simulate::Preset& preset)
      : preset_(preset), camera_(make_camera<double>(camera_of(preset))) {}

  std::optional<Eigen::Vector2d> pixel_of(const simulate::View& view,
                                          const Eigen::Vector3d& point) const {
    const auto image = camera_.project(view.rotation * (point - view.centre));
    if (!image.visible || image.pixel.minCoeff() < 0 || image.pixel.x() > preset_.lens.width - 1 ||
        image.pixel.y() > preset_.lens.height - 1)
      return {};
    return image.pixel;
  }

  bool sees(const simulate::View& view, const simulate::RayScene& scene,
            const Eigen::Vector3d& point) const {
    const auto pixel = pixel_of(view, point);
    if (!pixel) return false;
    const auto ray = simulate::trace_pixel(preset_.lens, &preset_.port, pixel->x(), pixel->y());
    if (!ray) return false;
    const simulate::SceneRay in_world = simulate::to_world(view, *ray);
    const double distance = (point - in_world.start).norm();
    return !scene.blocked(in_world.start, in_world.direction, 0, distance * (1 - 1e-3));
  }

 private:
  const simulate::Preset& preset_;
  AnyCamera<double> camera_;
};

Eigen::Vector2d place_in(const map::MapGrid& grid, double column, double row) {
  return {grid.left + column * grid.pixel, grid.top - row * grid.pixel};
}

}  // namespace

TrueMap true_map(const SimulatedScene& of, const map::MapGrid& grid) {
  const simulate::RayScene scene(of.mesh);
  const simulate::Shader shader = simulate::seabed_shader(of.mesh, scene, of.preset.texture);
  const Photographers photographers(of.preset);
  TrueMap truth{cv::Mat1f(grid.rows, grid.columns, std::nanf("")),
                cv::Mat3b(grid.rows, grid.columns, cv::Vec3b(0, 0, 0)),
                cv::Mat1b(grid.rows, grid.columns, std::uint8_t{0}),
                cv::Mat1b(grid.rows, grid.columns, std::uint8_t{0}),
                cv::Mat1b(grid.rows, grid.columns, std::uint8_t{0})};
  constexpr double kAbove = 100;  // [m]
  constexpr int kSide = 3;
  parallel_for(static_cast<std::size_t>(grid.rows), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < grid.columns; ++x) {
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      int hits = 0;
      for (int i = 0; i < kSide * kSide; ++i) {
        const Eigen::Vector2d at =
            place_in(grid, x + (i % kSide + 0.5) / kSide, y + (i / kSide + 0.5) / kSide);
        const auto hit = scene.first_hit({at.x(), at.y(), kAbove}, -Eigen::Vector3d::UnitZ());
        if (!hit) continue;
        ++hits;
        const Eigen::Vector3d point(at.x(), at.y(), kAbove - hit->distance);
        sum += shader({point, *hit, grid.pixel});
        if (i != kSide * kSide / 2) continue;
        truth.heights(y, x) = static_cast<float>(point.z());
        for (const simulate::View& view : of.preset.views) {
          truth.frames(y, x) += photographers.pixel_of(view, point).has_value();
          truth.views(y, x) += photographers.sees(view, scene, point);
        }
      }
      if (hits < kSide * kSide) continue;
      truth.known(y, x) = 255;
      for (int k = 0; k < 3; ++k)
        truth.colors(y, x)[k] = cv::saturate_cast<std::uint8_t>(255 * sum[k] / (kSide * kSide));
    }
  });
  return truth;
}

NearestMaps nearest_maps(const SimulatedScene& of, const map::MapGrid& grid, const TrueMap& truth,
                         const std::filesystem::path& photographs) {
  const Photographers photographers(of.preset);
  const simulate::RayScene scene(of.mesh);
  const cv::Size size(grid.columns, grid.rows);
  NearestMaps maps{cv::Mat3b(size, cv::Vec3b(0, 0, 0)), cv::Mat1b(size, std::uint8_t{0}),
                   cv::Mat3b(size, cv::Vec3b(0, 0, 0))};
  cv::Mat1d nearest(size, std::numeric_limits<double>::infinity());
  cv::Mat1d nearest_visible = nearest.clone();
  for (std::size_t v = 0; v < of.preset.views.size(); ++v) {
    const simulate::View& view = of.preset.views[v];
    const cv::Mat3b photograph = io::read_color_image(photographs / fmt::format("{:04}.jpg", v));
    parallel_for(static_cast<std::size_t>(grid.rows), [&](std::size_t row) {
      const int y = static_cast<int>(row);
      for (int x = 0; x < grid.columns; ++x) {
        if (std::isnan(truth.heights(y, x))) continue;
        const Eigen::Vector2d at = place_in(grid, x + 0.5, y + 0.5);
        const Eigen::Vector3d point(at.x(), at.y(), static_cast<double>(truth.heights(y, x)));
        const double distance = (point - view.centre).norm();
        const auto pixel = photographers.pixel_of(view, point);
        if (!pixel || distance >= nearest_visible(y, x)) continue;
        const bool sees = photographers.sees(view, scene, point);
        const Eigen::Vector3f bgr = bilinear(photograph, pixel->cast<float>());
        const cv::Vec3b color(cv::Vec3f(bgr[2], bgr[1], bgr[0]));
        if (sees) nearest_visible(y, x) = distance, maps.visible(y, x) = color;
        if (distance >= nearest(y, x)) continue;
        nearest(y, x) = distance, maps.naive(y, x) = color;
        maps.wrong(y, x) = sees ? 0 : 255;
      }
    });
  }
  return maps;
}

}  // namespace axial::map_check
