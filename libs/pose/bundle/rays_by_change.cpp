// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/bundle/rays_by_change.h"

namespace axial::pose {

RaysByChange::Camera RaysByChange::camera_behind(const refractive::FlatPort<Jet>& port) {
  // Rays do not depend on the field.
  const refractive::FlatPortField<Jet> any(refractive::FlatPortOptics<Jet>(port), Jet(1), Jet(1));
  return refractive::FlatPortCamera<Jet>(refractive::tangent_lens<Jet>(), port, any,
                                         refractive::all_tangents<Jet>());
}

RaysByChange::Camera RaysByChange::camera_behind(const refractive::DomePort<Jet>& port) {
  return refractive::DomePortCamera<Jet>(refractive::tangent_lens<Jet>(), port,
                                         refractive::all_tangents<Jet>());
}

RaysByChange::RaysByChange(const std::optional<refractive::Port<double>>& measured,
                           const HousingChange<double>& change) {
  if (!measured) return;
  HousingChange<Jet> jets = change.cast<Jet>();
  for (int k = 0; k < kPortNumbers; ++k) jets(k).v(k) = 1;
  camera_ = std::visit([&](const auto& port) { return camera_behind(with_change(port, jets)); },
                       *measured);
}

Eigen::Matrix<double, 3, kPortNumbers> RaysByChange::at(const Eigen::Vector2d& tangents,
                                                        double lambda) const {
  Eigen::Matrix<double, 3, kPortNumbers> derivative;
  derivative.setZero();
  std::visit(
      [&]<class Camera>(const Camera& camera) {
        if constexpr (!std::is_same_v<Camera, std::monostate>) {
          const refractive::Vector2<Jet> at = tangents.cast<Jet>();
          const refractive::Vector3<Jet> point = camera.ray(at).at(Jet(lambda));
          for (int k = 0; k < 3; ++k) derivative.row(k) = point(k).v.transpose();
        }
      },
      camera_);
  return derivative;
}

}  // namespace axial::pose
