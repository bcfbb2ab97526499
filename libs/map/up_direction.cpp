// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/up_direction.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/parse_number.h"
#include "base/split.h"

namespace axial::map {

std::optional<Eigen::Vector3d> parse_up(const std::string& text, int epsg) {
  if (text.empty()) return {};
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  const auto parts = split(text, ',');
  for (std::size_t k = 0; k < 3; ++k) {
    const auto number = parts.size() == 3 ? parse_finite<double>(parts[k]) : std::nullopt;
    if (!number) fail("{} {}: must be three numbers X,Y,Z", setting("up"), text);
    up[static_cast<Eigen::Index>(k)] = *number;
  }
  const double largest = up.cwiseAbs().maxCoeff();
  if (!(largest > 0)) fail("{} {}: is no direction", setting("up"), text);
  up /= largest;  // the square of a tiny or huge number is 0 or infinite
  if (epsg > 0 && !(up.z() > 0 && up.head<2>().isZero(0)))
    fail("{} {}: must be 0,0,1 with {}, whose heights are along z", setting("up"), text,
         setting("epsg"));
  return up;
}

std::string up_text(const Eigen::Vector3d& up) {
  const Eigen::Vector3d plain = up + Eigen::Vector3d::Zero();  // -0 becomes 0
  return fmt::format("{:g},{:g},{:g}", plain.x(), plain.y(), plain.z());
}

bool shows_far_side(const Eigen::Vector3d& up, const Eigen::Vector3d& facing) {
  constexpr double kLeast = 0.2;
  return up.normalized().dot(facing) < -kLeast;
}

}  // namespace axial::map
