// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cameras/moved_housing.h"

namespace axial::io {
namespace {

void move(const Similarity&, double length_factor, refractive::FlatPort<double>& port) {
  port.distance *= length_factor;
  port.thickness *= length_factor;
}

void move(const Similarity&, double length_factor, refractive::DomePort<double>& port) {
  port.centre *= length_factor;
  port.inner_radius *= length_factor;
  port.thickness *= length_factor;
}

void move(const Similarity& similarity, double, WaterSurface& surface) {
  surface.normal = (similarity.rotation * surface.normal).normalized();
  surface.point = similarity(surface.point);
}

}  // namespace

Housing moved(const Similarity& similarity, Housing housing, bool scale_ports) {
  const double length_factor = scale_ports ? similarity.scale : 1;
  for (auto& [name, port] : housing.ports)
    std::visit([&](auto& one) { move(similarity, length_factor, one); }, port);
  for (auto& [name, sigmas] : housing.sigmas) sigmas = scaled(sigmas, length_factor);
  return housing;
}

}  // namespace axial::io
