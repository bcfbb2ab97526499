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
  const pose::Sigmas usual = diagnosis::usual_sigmas();
  io::Housing housing = io::housing_with(io::to_housing_port(*diagnosis::usual_port(kind)));
  io::PortSigmas sigmas;
  sigmas.index = usual.index;
  if (kind == pose::PortKind::flat) {
    sigmas.normal_degrees = Eigen::Vector2d::Constant(usual.normal_degrees);
    sigmas.distance = usual.distance;
  } else {
    sigmas.centre = Eigen::Vector3d::Constant(usual.centre);
  }
  housing.sigmas[housing.default_port] = sigmas;
  return housing;
}

}  // namespace axial::apps
