// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/tube.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace axial::simulate {
namespace {

// A cross section.
struct Ring {
  Eigen::Vector3d centre, across, up;  // across and up: unit, square to the spine
  double radius = 0;
};

Eigen::Vector3d direction_at(const std::vector<Eigen::Vector3d>& spine, std::size_t i) {
  const std::size_t before = i > 0 ? i - 1 : 0, after = std::min(i + 1, spine.size() - 1);
  return (spine[after] - spine[before]).normalized();
}

Eigen::Vector3d square_to(const Eigen::Vector3d& along, const Eigen::Vector3d& wish) {
  return (wish - wish.dot(along) * along).normalized();
}

// The rings of the tube. The first and the last ring close it: they are almost points, half a
// radius beyond the ends.
std::vector<Ring> rings_of(const Tube& tube) {
  std::vector<Ring> rings;
  const Eigen::Vector3d first = direction_at(tube.spine, 0);
  Eigen::Index least = 0;
  first.cwiseAbs().minCoeff(&least);
  Eigen::Vector3d across = Eigen::Vector3d::Unit(least);
  for (std::size_t i = 0; i < tube.spine.size(); ++i) {
    const Eigen::Vector3d along = direction_at(tube.spine, i);
    across = square_to(along, across);  // transported without twist
    rings.push_back({tube.spine[i], across, along.cross(across), tube.radii[i]});
  }
  constexpr double kPoint = 1e-3;  // of the radius; not 0, so that faces keep an area
  const auto cap = [&](Ring ring, const Eigen::Vector3d& outward) {
    ring.centre += 0.5 * ring.radius * outward;
    ring.radius *= kPoint;
    return ring;
  };
  rings.insert(rings.begin(), cap(rings.front(), -first));
  rings.push_back(cap(rings.back(), direction_at(tube.spine, tube.spine.size() - 1)));
  return rings;
}

}  // namespace

TriangleMesh tube_mesh(const Tube& tube, double cell) {
  const std::vector<Ring> rings = rings_of(tube);
  const double widest = *std::ranges::max_element(tube.radii);
  const auto columns = static_cast<std::size_t>(
      std::clamp(std::ceil(2 * std::numbers::pi * widest / cell), 8.0, 48.0));
  TriangleMesh mesh =
      grid_mesh(rings.size(), columns, true, [&](std::size_t r, std::size_t c) -> Eigen::Vector3d {
        const Ring& ring = rings[r];
        // Clockwise about the spine, so that faces point outwards.
        const double angle =
            -2 * std::numbers::pi * static_cast<double>(c) / static_cast<double>(columns);
        return ring.centre +
               ring.radius * (std::cos(angle) * ring.across + std::sin(angle) * ring.up);
      });
  for (std::size_t r = 0; r < rings.size(); ++r) {
    const std::size_t of_tube = std::clamp<std::size_t>(r, 1, rings.size() - 2) - 1;
    mesh.thickness.insert(mesh.thickness.end(), columns,
                          static_cast<float>(2 * tube.radii[of_tube]));
  }
  return mesh;
}

}  // namespace axial::simulate
