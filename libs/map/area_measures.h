// SPDX-License-Identifier: GPL-3.0-or-later
// Sizes and shape of the surface above a polygon.
#pragma once

#include <span>

#include "geometry/surface.h"
#include "map/areas.h"
#include "scene/mesh.h"

namespace axial::map {

// A plane as heights: height = level + gradient * ((x, y) - middle).
struct HeightPlane {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero(), gradient = Eigen::Vector2d::Zero();
  double level = 0;
  double variance = 0;  // of the heights to which it was fitted, from the plane

  double height_of(const Eigen::Vector3d& x) const {
    return x.z() - level - gradient.dot(x.head<2>() - middle);
  }
};

// How large and how rough a part of a surface is. Lengths are in metres; x, y and height are those
// of the map.
struct AreaMeasures {
  double polygon = 0;  // area of the polygon [m^2]
  // Area of the polygon in which there is a surface, seen from above [m^2].
  double planar = 0;
  double surface = 0;              // area of the surface itself, also of overhanging parts [m^2]
  HeightPlane plane;               // fits the heights best
  double lowest = 0, highest = 0;  // [m]
  // Between the surface and the plane through the surface at the rim of the polygon [m^3].
  double above = 0, below = 0;
  double rim = 0;  // the share of the rim at which there is a surface

  double rugosity() const { return surface / planar; }
  // Surface over the area of the fitted plane: without the slope.
  double rugosity_on_slope() const;
  double roughness() const;  // standard deviation of the heights from the plane [m]
  double slope_degrees() const;
  // The direction in which the plane falls, clockwise from the map's y axis, 0 to 360 degrees.
  double aspect_degrees() const;
};

// Measures surfaces above polygons. The coordinates of the mesh are those of the map minus
// `origin`.
class AreaMeter {
 public:
  // `mesh` must outlive the object. Errors as for geometry::Surface.
  AreaMeter(const Mesh& mesh, const Eigen::Vector3d& origin);

  // All members but `polygon` are 0 if no surface is above the polygon. Parts are exact up to
  // rounding: faces are clipped at the polygon. Faces that are turned down take from `planar` and
  // from the volumes what the faces above them add, so that overhanging surfaces count once. The
  // rim is looked at from above in 2000 places. Without a surface at half of them, `above` and
  // `below` are NaN.
  AreaMeasures measure(const Area& area) const;

 private:
  // The plane through the surface at the rim; its level is NaN if less than half of the rim has a
  // surface. `share`: of the rim.
  HeightPlane rim_of(std::span<const geometry::Ring> rings, double& share) const;

  const Mesh& mesh_;
  Eigen::Vector3d origin_;
  geometry::Surface surface_;
  double top_ = 0;  // above the highest vertex
};

}  // namespace axial::map
