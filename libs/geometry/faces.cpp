// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/faces.h"

#include "base/error.h"

namespace axial::geometry {
namespace {

struct Sums {
  double twice_area = 0;
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();  // of area_vector()
};

Sums sums_of(const Mesh& mesh) {
  Sums sums;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Eigen::Vector3d vector = area_vector(mesh, f);
    sums.vector += vector;
    sums.twice_area += vector.norm();
  }
  if (!(sums.twice_area > 0)) fail("the mesh has no area");
  return sums;
}

}  // namespace

double area_of(const Mesh& mesh) {
  return sums_of(mesh).twice_area / 2;
}

Eigen::Vector3d mean_normal(const Mesh& mesh) {
  const Sums sums = sums_of(mesh);
  return sums.vector / sums.twice_area;
}

}  // namespace axial::geometry
