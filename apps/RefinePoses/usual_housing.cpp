// SPDX-License-Identifier: GPL-3.0-or-later
#include "usual_housing.h"

namespace axial::apps {

bool is_usual_housing(std::string_view word) {
  return word == "unknown" || kind_named(word).has_value();
}

std::optional<pose::PortKind> kind_named(std::string_view word) {
  if (word == "flat") return pose::PortKind::flat;
  if (word == "dome") return pose::PortKind::dome;
  return {};
}

io::Housing usual_housing(pose::PortKind kind) {
  constexpr double kNormal = 3, kDistance = 0.03, kCentre = 0.01, kIndex = 0.004;
  io::Housing housing = io::housing_with(io::to_housing_port(*pose::usual_port(kind)));
  io::PortSigmas sigmas;
  sigmas.index = kIndex;
  if (kind == pose::PortKind::flat) {
    sigmas.normal_degrees = Eigen::Vector2d::Constant(kNormal);
    sigmas.distance = kDistance;
  } else {
    sigmas.centre = Eigen::Vector3d::Constant(kCentre);
  }
  housing.sigmas[housing.default_port] = sigmas;
  return housing;
}

}  // namespace axial::apps
