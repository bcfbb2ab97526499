// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/housing_change.h"

#include <ceres/jet.h>

namespace axial::pose {
namespace {

using Jet = ceres::Jet<double, kPortNumbers>;

refractive::AxialRay<Jet> ray_behind(const refractive::FlatPort<Jet>& port,
                                     const refractive::Vector2<Jet>& tangents) {
  // Rays do not depend on the field.
  const refractive::FlatPortField<Jet> any(refractive::FlatPortOptics<Jet>(port), Jet(1), Jet(1));
  return refractive::FlatPortCamera<Jet>(refractive::tangent_lens<Jet>(), port, any,
                                         refractive::all_tangents<Jet>())
      .ray(tangents);
}

refractive::AxialRay<Jet> ray_behind(const refractive::DomePort<Jet>& port,
                                     const refractive::Vector2<Jet>& tangents) {
  return refractive::DomePortCamera<Jet>(refractive::tangent_lens<Jet>(), port,
                                         refractive::all_tangents<Jet>())
      .ray(tangents);
}

}  // namespace

HousedCamera with_change(const HousedCamera& measured, const HousingChange<double>& change) {
  HousedCamera camera = measured;
  camera.lens.pinhole = with_change(measured.lens.pinhole, change);
  if (measured.port)
    camera.port = std::visit(
        [&](const auto& port) { return refractive::Port<double>(with_change(port, change)); },
        *measured.port);
  return camera;
}

Eigen::Matrix<double, 3, kPortNumbers> ray_by_change(
    const std::optional<refractive::Port<double>>& measured, const HousingChange<double>& change,
    const Eigen::Vector2d& tangents, double lambda) {
  Eigen::Matrix<double, 3, kPortNumbers> derivative;
  derivative.setZero();
  if (!measured) return derivative;
  HousingChange<Jet> jets = change.cast<Jet>();
  for (int k = 0; k < kPortNumbers; ++k) jets(k).v(k) = 1;
  const refractive::Vector2<Jet> at = tangents.cast<Jet>();
  const refractive::Vector3<Jet> point = std::visit(
      [&](const auto& port) { return ray_behind(with_change(port, jets), at).at(Jet(lambda)); },
      *measured);
  for (int k = 0; k < 3; ++k) derivative.row(k) = point(k).v.transpose();
  return derivative;
}

}  // namespace axial::pose
