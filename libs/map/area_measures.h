// SPDX-License-Identifier: GPL-3.0-or-later
// Sizes and shape of the surface above a polygon.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "geometry/surface.h"
#include "map/areas.h"
#include "map/surface_block.h"
#include "scene/mesh.h"

namespace axial::map {

inline constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

// A plane as heights: height = level + gradient * ((x, y) - middle).
struct HeightPlane {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero(), gradient = Eigen::Vector2d::Zero();
  double level = kNotKnown;     // NaN: there is no plane
  double variance = kNotKnown;  // of the heights to which it was fitted, from the plane

  bool is_known() const { return std::isfinite(level); }

  double height_of(const Eigen::Vector3d& x) const {
    return x.z() - level - gradient.dot(x.head<2>() - middle);
  }
};

// How large and how rough a part of a surface is. Lengths are in metres; x, y and height are those
// of the map. Without a surface, all members but the areas and `rim` are NaN, and so are the
// results of the functions.
struct AreaMeasures {
  double polygon = 0;  // area of the polygon [m^2]
  // Area of the polygon in which there is a surface, seen from above [m^2].
  double planar = 0;
  double surface = 0;  // area of the surface itself, also of overhanging parts [m^2]
  HeightPlane plane;   // fits the heights best
  double lowest = kNotKnown, highest = kNotKnown;  // [m]
  // Between the surface and the plane through the surface at the rim of each part of the polygon
  // [m^3].
  double above = kNotKnown, below = kNotKnown;
  double rim = 0;  // the share of the rim at which there is a surface

  double rugosity() const;
  // Surface over the area of the fitted plane: without the slope.
  double rugosity_on_slope() const;
  double roughness() const;  // standard deviation of the heights from the plane [m]
  double slope_degrees() const;
  // The direction in which the plane falls, clockwise from the map's y axis, from 0 to 360 degrees.
  // NaN for a level plane.
  double aspect_degrees() const;
};

struct AreaSums;  // of area_measures.cpp

// Measures surfaces above polygons. The coordinates of the mesh are those of the map minus
// `origin`.
class AreaMeter {
 public:
  // `mesh` must outlive the object; its faces are turned up. Errors as for geometry::Surface.
  AreaMeter(const Mesh& mesh, const Eigen::Vector3d& origin);

  // The memory [bytes] of an AreaMeter of `mesh` while it is made.
  static std::uint64_t bytes(const Mesh& mesh);

  // Faces are clipped at the polygon, so that all numbers are exact up to rounding. Faces that are
  // turned down take from `planar` and from the volumes what the faces above and below them add:
  // overhanging surfaces count once if their lower side is there. The rim of a part is looked at
  // from above in 2000 places. If less than half of them has a surface, `above` and `below` are
  // NaN. The result does not depend on the number of threads. Errors as for
  // geometry::PolygonPieces.
  AreaMeasures measure(const Area& area) const;

 private:
  // The faces that may be above a box, in increasing order.
  std::vector<std::uint32_t> faces_in(const Eigen::AlignedBox2d& box) const;
  // Adds the faces above a part of a polygon. Returns the share of its rim that has a surface.
  double add_part(std::span<const geometry::Ring> rings, AreaMeasures& found, AreaSums& sums) const;
  // The plane through the surface at the rim; none if less than half of the rim has a
  // surface. `share`: of the rim.
  HeightPlane rim_of(std::span<const geometry::Ring> rings, double& share) const;

  const Mesh& mesh_;
  Eigen::Vector3d origin_;
  geometry::Surface surface_;
  MapGrid grid_;
  FaceBins bins_;
  double top_ = 0;  // above the highest vertex
};

}  // namespace axial::map
