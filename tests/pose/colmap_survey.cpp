// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/colmap_survey.h"

namespace axial::pose::testing {

io::Housing housing() {
  io::Housing housing;
  housing.ports["main"] = flat_port(2);
  housing.default_port = "main";
  return housing;
}

Eigen::Vector2d seen_by_lens(double u, double v) {
  const std::vector<double>& p = kLens.params;
  const double r2 = u * u + v * v, radial = 1 + p[4] * r2 + p[5] * r2 * r2;
  const double x = u * radial + 2 * p[6] * u * v + p[7] * (r2 + 2 * u * u);
  const double y = v * radial + 2 * p[7] * u * v + p[6] * (r2 + 2 * v * v);
  return {p[0] * x + p[2] - 0.5, p[1] * y + p[3] - 0.5};
}

io::ColmapModel model_of(const Bundle& bundle) {
  io::ColmapModel model;
  model.cameras = {{4, "SIMPLE_RADIAL", 1024, 768, {800, 512, 384, 0.1}}};
  for (std::size_t i = 0; i < bundle.images.size(); ++i) {
    io::ColmapImage image;
    image.id = static_cast<std::uint32_t>(i + 10);
    image.camera = 4;
    image.name = bundle.images[i].name;
    image.pose = bundle.images[i].pose;
    model.images.push_back(image);
  }
  for (std::size_t i = 0; i < bundle.points.size(); ++i)
    model.points.push_back({i + 1000, bundle.points[i].position, {1, 2, 3}, 0, {}});
  const auto& lens = bundle.cameras[0].measured.lens.pinhole;
  for (const Observation& observation : bundle.observations) {
    const Eigen::Vector3d bearing = lens.bearing(observation.pixel);
    const Eigen::Vector2d pixel = seen_by_lens(bearing.x(), bearing.y());
    io::ColmapImage& image = model.images[observation.image];
    io::ColmapPoint3D& point = model.points[observation.point];
    point.track.push_back({image.id, static_cast<std::uint32_t>(image.points.size())});
    image.points.push_back({pixel.x() + 0.5, pixel.y() + 0.5, point.id});
  }
  return model;
}

}  // namespace axial::pose::testing
