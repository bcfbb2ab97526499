// SPDX-License-Identifier: GPL-3.0-or-later
// A mesh of the textured scene (support/textured_scene.h), and photographs of the scene.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "axial/refine.h"
#include "base/order_statistics.h"
#include "support/textured_scene.h"
#include "worlds/height_field.h"
#include "worlds/ports.h"

namespace axial::test {

enum class Optics { pinhole, distorted, flat_port };

inline CameraModel camera_behind(Optics optics) {
  CameraModel model;
  model.width = 200, model.height = 150;
  model.lens = {170, 171, 99, 75};
  if (optics == Optics::distorted) model.distortion.emplace().above = {1, -0.1, 0.02, 0, 0};
  if (optics == Optics::flat_port) model.port = flat_port(0.03, 0.01, {0.03, -0.02, 1});
  return model;
}

class PhotographedMesh {
 public:
  explicit PhotographedMesh(Optics optics = Optics::pinhole) {
    for (const double x : {-0.25, 0.05, 0.3})
      for (const double y : {-0.15, 0.2}) {
        geometry::PosedCamera view{camera_behind(optics), {}};
        view.pose.centre = {x, y, 0.4};
        views.push_back(view);
        pictures.push_back({render(scene, view.camera, view.pose).image, {}});
      }
  }

  // The z coordinate [m] of the surface at (x, y). The z axis points downwards.
  double height(double x, double y) const { return scene.depth({x, y, 0}, {0, 0, 1}); }

  // A grid of vertices on the surface, with noise of the standard deviation `noise` [m].
  Mesh mesh(double noise, double spacing = 0.015) const {
    Mesh result;
    const int count = static_cast<int>(1.1 / spacing);
    for (int row = 0; row <= count; ++row)
      for (int column = 0; column <= count; ++column) {
        const double x = -0.55 + spacing * column, y = -0.55 + spacing * row;
        const double z = height(x, y) + noise * normal(result.vertices.size());
        result.vertices.push_back(Eigen::Vector3d(x, y, z).cast<float>());
      }
    result.faces = grid_faces(static_cast<std::uint32_t>(count), static_cast<std::uint32_t>(count));
    return flipped(std::move(result));  // seen from above, where z is smaller
  }

  // The median of the distances |z - height(x, y)| [m] of the vertices, without vertices near the
  // border.
  double error(const Mesh& mesh) const { return median_error(mesh.vertices); }

  // The same for the centres of the faces.
  double error_of_faces(const Mesh& mesh) const {
    std::vector<Eigen::Vector3f> centres;
    for (const auto& [a, b, c] : mesh.faces)
      centres.push_back((mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3);
    return median_error(centres);
  }

  refine::Report refine(Mesh& mesh, const refine::Options& options = {},
                        const Context& context = {}) const {
    return refine::refine(
        mesh, views, [&](std::size_t i) { return pictures[i]; }, options, context);
  }

  TexturedScene scene{.cell = 0.025};
  std::vector<geometry::PosedCamera> views;
  std::vector<refine::Picture> pictures;

 private:
  double median_error(std::span<const Eigen::Vector3f> points) const {
    std::vector<double> errors;
    for (const Eigen::Vector3f& x : points)
      if (std::abs(x.x()) < 0.4f && std::abs(x.y()) < 0.4f)
        errors.push_back(std::abs(x.z() - height(x.x(), x.y())));
    return upper_median(std::move(errors));
  }

  // A standard normal number that depends on `key`, by the method of Box and Muller.
  static double normal(std::uint64_t key) {
    const double a = 1 - unit_float(scramble(2 * key + 1)), b = unit_float(scramble(2 * key + 2));
    return std::sqrt(-2 * std::log(std::max(a, 1e-9))) * std::cos(2 * M_PI * b);
  }
};

}  // namespace axial::test
