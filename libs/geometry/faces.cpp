// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/faces.h"

#include "base/error.h"

namespace axial::geometry {

double area_of(const Mesh& mesh) {
  double twice = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) twice += area_vector(mesh, f).norm();
  if (!(twice > 0)) fail("the mesh has no area");
  return twice / 2;
}

Eigen::Vector3d mean_normal(const Mesh& mesh) {
  Eigen::Vector3d twice = Eigen::Vector3d::Zero();
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) twice += area_vector(mesh, f);
  return twice / (2 * area_of(mesh));
}

}  // namespace axial::geometry
