// SPDX-License-Identifier: GPL-3.0-or-later
#include "belong/shape.h"

namespace axial::belong {

Eigen::Vector3d Shape::middle(std::size_t part) const {
  if (faces.empty()) return vertices[part].cast<double>();
  const auto& [a, b, c] = faces[part];
  return (vertices[a].cast<double>() + vertices[b].cast<double>() + vertices[c].cast<double>()) / 3;
}

Shape shape_of(const Mesh& mesh) {
  return {mesh.vertices, mesh.faces};
}

Shape shape_of(const PointCloud& cloud) {
  return {cloud.positions};
}

}  // namespace axial::belong
