// SPDX-License-Identifier: GPL-3.0-or-later
// The standard deviations with which the numbers of a port were measured (docs/formats.md).
#pragma once

#include <Eigen/Core>
#include <optional>

namespace axial::io {

// The standard deviations that a housing file states for one port. A number without a value has no
// stated standard deviation. All values are above 0.
struct PortSigmas {
  // Flat ports: the tilts of the normal to the right and downwards [degrees].
  std::optional<Eigen::Vector2d> normal_degrees = {};
  std::optional<double> distance = {};         // flat ports: of the distance [m]
  std::optional<Eigen::Vector3d> centre = {};  // domes: of the coordinates of the centre [m]
  std::optional<double> thickness = {};        // of the glass [m]
  std::optional<double> index = {};            // of the refractive index of the water

  bool empty() const { return *this == PortSigmas{}; }
  bool operator==(const PortSigmas&) const = default;
};

// Returns the sigmas of a port whose lengths have been multiplied by `factor`.
PortSigmas scaled(PortSigmas sigmas, double factor);

}  // namespace axial::io
