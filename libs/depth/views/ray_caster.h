// SPDX-License-Identifier: GPL-3.0-or-later
// Computes the rays of a camera's pixels, for kRayTile pixels of a row at a time. For the camera
// types that the SIMD code supports (InLanes), the rays are computed with SIMD, for other types one
// after the other. All rays and their derivatives are in the camera's frame.
#pragma once

#include <memory>
#include <utility>

#include "depth/views/camera_fields.h"
#include "depth/views/reference_pixel.h"

namespace axial::depth {

// The ray caster for any camera type, without SIMD.
template <class Camera>
class RayCaster {
 public:
  explicit RayCaster(Camera camera) : camera_(std::move(camera)) {}

  // Sets `tile` to the rays of the pixels (x, y) to (x + kRayTile - 1, y), with their derivatives.
  // The pixels may lie outside the image.
  void rays(int x, int y, RayTile& tile) const {
    for (int k = 0; k < kRayTile; ++k) {
      PixelRay& pixel = tile[static_cast<std::size_t>(k)];
      pixel.ray = camera_.ray({static_cast<float>(x + k), static_cast<float>(y)}, pixel.jacobian);
    }
  }

 private:
  Camera camera_;
};

// The ray caster with SIMD. Its rays are bit-identical to the results of the camera's ray().
class LaneRayCaster {
 public:
  // `tables`: the result of ray_tables(). Precondition: `set` is available.
  LaneRayCaster(std::unique_ptr<const lanes::SceneTables> tables, lanes::InstructionSet set)
      : tables_(std::move(tables)), scorer_(lanes::make_scorer(*tables_, set)) {}

  // Sets `tile` to the rays of the pixels (x, y) to (x + kRayTile - 1, y), with their derivatives.
  // The pixels may lie outside the image.
  void rays(int x, int y, RayTile& tile) const;

 private:
  std::unique_ptr<const lanes::SceneTables> tables_;
  std::unique_ptr<const lanes::Scorer> scorer_;
};

// Returns tables for Scorer::rays(), with `camera` as the reference camera and without source
// views.
template <InLanes Camera>
std::unique_ptr<const lanes::SceneTables> ray_tables(const Camera& camera);

// The ray caster for the camera types that the SIMD code supports.
template <InLanes Camera>
class RayCaster<Camera> : public LaneRayCaster {
 public:
  explicit RayCaster(const Camera& camera,
                     lanes::InstructionSet set = lanes::fastest_instruction_set())
      : LaneRayCaster(ray_tables(camera), set) {}
};

// Calls visit(x, ray) for the first `width` pixels of row y, from left to right. `ray` is the
// AxialRay of the pixel.
template <class Camera, class Visit>
void each_ray_of_row(const RayCaster<Camera>& caster, int y, int width, Visit&& visit) {
  RayTile tile;
  for (int x = 0; x < width; ++x) {
    if (x % kRayTile == 0) caster.rays(x, y, tile);
    visit(x, tile[static_cast<std::size_t>(x % kRayTile)].ray);
  }
}

// Calls visit(x, y, ray) for every pixel of an image of width x height pixels, row by row. `ray` is
// the AxialRay of the pixel.
template <class Camera, class Visit>
void each_ray(const Camera& camera, int width, int height, Visit&& visit) {
  const RayCaster<Camera> caster(camera);
  for (int y = 0; y < height; ++y)
    each_ray_of_row(caster, y, width, [&](int x, const auto& ray) { visit(x, y, ray); });
}

}  // namespace axial::depth
