// SPDX-License-Identifier: GPL-3.0-or-later
#include "private/polygon_shapes.h"

#include <utility>

namespace axial::map {
namespace {

geometry::Ring ring_of(OGRGeometryH line) {
  geometry::Ring ring;
  for (int k = 0; k < OGR_G_GetPointCount(line); ++k) {
    const Eigen::Vector2d corner(OGR_G_GetX(line, k), OGR_G_GetY(line, k));
    if (ring.empty() || corner != ring.back()) ring.push_back(corner);
  }
  if (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
  return ring;
}

}  // namespace

Geometry shape_of_parts(std::span<const std::vector<geometry::Ring>> parts) {
  Geometry shape(OGR_G_CreateGeometry(wkbMultiPolygon));
  for (const auto& rings : parts) {
    const OGRGeometryH polygon = OGR_G_CreateGeometry(wkbPolygon);
    for (const geometry::Ring& ring : rings) {
      const OGRGeometryH line = OGR_G_CreateGeometry(wkbLinearRing);
      for (const Eigen::Vector2d& corner : ring) OGR_G_AddPoint_2D(line, corner.x(), corner.y());
      OGR_G_CloseRings(line);
      OGR_G_AddGeometryDirectly(polygon, line);
    }
    OGR_G_AddGeometryDirectly(shape.get(), polygon);
  }
  return shape;
}

void add_parts(OGRGeometryH shape, std::vector<std::vector<geometry::Ring>>& parts) {
  const int count = OGR_G_GetGeometryCount(shape);
  const OGRwkbGeometryType type = wkbFlatten(OGR_G_GetGeometryType(shape));
  if (type == wkbMultiPolygon || type == wkbGeometryCollection) {
    for (int i = 0; i < count; ++i) add_parts(OGR_G_GetGeometryRef(shape, i), parts);
    return;
  }
  if (type != wkbPolygon) return;
  std::vector<geometry::Ring> part;
  for (int i = 0; i < count; ++i) part.push_back(ring_of(OGR_G_GetGeometryRef(shape, i)));
  if (!part.empty()) parts.push_back(std::move(part));
}

}  // namespace axial::map
