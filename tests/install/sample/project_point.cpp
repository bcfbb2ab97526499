// SPDX-License-Identifier: GPL-3.0-or-later
// Prints where a camera behind a flat port sees a point in the water, and how far the ray of that
// pixel passes from the point [m].
#include <cstdio>

#include "refractive/flat_port_camera.h"

using namespace axial::refractive;

int main() {
  const PinholeLens<double> lens{800, 800, 511.5, 383.5};
  FlatPort<double> port;
  port.distance = 0.02;
  port.thickness = 0.014;
  port.n_glass = 1.52;
  port.n_water = 1.333;
  const FlatPortCamera<double> camera(lens, port, 1024, 768);
  const Eigen::Vector3d point(0.5, -0.3, 1.5);
  const auto image = camera.project(point);
  const auto ray = camera.ray(image.pixel);
  const double along = (point - ray.origin).dot(ray.direction);
  std::printf("%d %.6f %.6f %.3e\n", image.visible ? 1 : 0, image.pixel.x(), image.pixel.y(),
              (ray.origin + along * ray.direction - point).norm());
}
