// SPDX-License-Identifier: GPL-3.0-or-later
// Random views through dome ports. The views cover the range of housings for which the project
// promises accuracy.
#pragma once

#include "refractive/dome_port_camera.h"
#include "refractive/views.h"

namespace axial::refractive::testing {

struct DomeView {
  int width = 0, height = 0;
  PinholeLens<double> lens{0, 0, 0, 0};
  DomePort<double> port;

  template <class T>
  DomePortCamera<T> camera() const {
    return {lens.cast<T>(), port.cast<T>(), width, height};
  }
  double outer_radius() const { return port.inner_radius + port.thickness; }
};

// Returns a random view: field of view 50 to 120 degrees, inner radius 30 to 120 mm, thickness of
// the glass 0 to 20 mm. The distance from the camera centre to the dome's centre is up to
// `decentring` times the inner radius, in any direction.
inline DomeView random_dome_view(Random& random, double decentring = 0.4) {
  DomeView view{1024, 768, lens_with_fov(random.uniform(50, 120), 1024, 768), {}};
  view.lens.cx += random.uniform(-0.02, 0.02) * view.width;
  view.lens.cy += random.uniform(-0.02, 0.02) * view.height;
  view.port.inner_radius = random.uniform(0.03, 0.12);
  view.port.centre = random.unit_vector() * random.uniform(0, decentring) * view.port.inner_radius;
  view.port.thickness = random.uniform(0, 0.02);
  view.port.n_air = 1.00028;
  view.port.n_glass = random.uniform(1.45, 1.78);
  view.port.n_water = random.uniform(1.325, 1.36);
  return view;
}

inline Vector2<double> random_pixel(Random& random, const DomeView& view) {
  return {random.uniform(0, view.width - 1), random.uniform(0, view.height - 1)};
}

// A point on the pixel's ray, 0.2 to 10 m from the glass.
template <class T>
Vector3<T> random_point(Random& random, const DomePortCamera<T>& camera, const Vector2<T>& pixel) {
  const AxialRay<T> ray = camera.ray(pixel);
  const T exit = (camera.exit_point(pixel) - ray.origin).dot(ray.direction);
  return ray.at(exit + static_cast<T>(random.log_uniform(0.2, 10)));
}

}  // namespace axial::refractive::testing
