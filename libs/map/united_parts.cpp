// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/united_parts.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "private/gdal_calls.h"
#include "private/polygon_shapes.h"

namespace axial::map {
namespace {

// Outlines that touch themselves are no valid shapes for GEOS.
Geometry valid_shape(const PolygonParts& parts) {
  const Geometry given = shape_of_parts(parts);
  Geometry shape(OGR_G_MakeValid(given.get()));
  if (!shape) fail("GEOS cannot take the outline of a polygon");
  return shape;
}

double area_of(OGRGeometryH shape) {
  return shape == nullptr ? 0 : OGR_G_Area(shape);
}

}  // namespace

double common_share(const PolygonParts& a, const PolygonParts& b) {
  const GdalErrors errors;
  const Geometry first = valid_shape(a), second = valid_shape(b);
  const double smaller = std::min(area_of(first.get()), area_of(second.get()));
  if (!(smaller > 0)) return 0;
  const Geometry common(OGR_G_Intersection(first.get(), second.get()));
  if (!common) fail("GEOS cannot intersect two polygons");
  return area_of(common.get()) / smaller;
}

PolygonParts united(std::span<const PolygonParts* const> polygons) {
  const GdalErrors errors;
  Geometry all;
  for (const PolygonParts* polygon : polygons) {
    Geometry shape = valid_shape(*polygon);
    if (all) shape.reset(OGR_G_Union(all.get(), shape.get()));
    if (!shape) fail("GEOS cannot unite two polygons");
    all = std::move(shape);
  }
  PolygonParts parts;
  if (all) add_parts(all.get(), parts);
  return parts;
}

}  // namespace axial::map
