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
#include "map/seen_faces.h"
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
// of the map. All numbers but `surface` are those of the surface that is seen from above: at each
// place the uppermost one (SeenFaces). Without a surface, all members but the areas and `rim` are
// NaN, and so are the results of the functions.
struct AreaMeasures {
  double polygon = 0;  // area of the polygon [m^2]
  double planar = 0;   // area of the polygon in which there is a surface [m^2]
  double seen = 0;     // area of the surface itself [m^2]
  double surface = 0;  // the same, with the surfaces below others [m^2]
  HeightPlane plane;   // fits the heights best
  double lowest = kNotKnown, highest = kNotKnown;  // [m]
  // Between the surface and the plane through the surface at the rim of each part of the polygon
  // [m^3].
  double above = kNotKnown, below = kNotKnown;
  double rim = 0;  // the share of the rim at which there is a surface
  // The distance of vertices: the root of twice the area of a face, in the mean over the surface
  // [m].
  double spacing = kNotKnown;
  // Standard deviation of the vertices along the normal [m], from vertex_bends(): it contains
  // relief that is not wider than two edges, and no errors that neighbouring vertices have in
  // common.
  double noise = kNotKnown;
  // Standard deviation of `above` and `below` by `noise` [m^3]: of the surface, of the plane
  // through the rim, and of the volume that noise alone gives where the surface lies near the
  // plane.
  double volume_noise = kNotKnown;

  double rugosity() const;        // seen / planar
  double whole_rugosity() const;  // surface / planar
  // Seen surface over the area of the fitted plane: without the slope.
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
  // `mesh` must outlive the object. Errors as for geometry::Surface.
  AreaMeter(const Mesh& mesh, const Eigen::Vector3d& origin);

  // The memory [bytes] of an AreaMeter of `mesh` while it is made.
  static std::uint64_t bytes(const Mesh& mesh);

  // Faces are clipped at the polygon and at the faces above them, so that all numbers are exact up
  // to rounding, but for the plane through the rim: the rim of a part is looked at from above in
  // 2000 places. If less than half of them has a surface, `above` and `below` are NaN. The result
  // does not depend on the number of threads. Errors as for geometry::PolygonPieces.
  AreaMeasures measure(const Area& area) const;

 private:
  // The variance of the vertices of a face along the normal, from their bends [m^2].
  double variance_at(std::uint32_t face) const;
  // Adds the faces above a part of a polygon. Returns the share of its rim that has a surface.
  double add_part(std::span<const geometry::Ring> rings, AreaMeasures& found, AreaSums& sums) const;
  // The plane through the surface at the rim; none if less than half of the rim has a
  // surface. `share`: of the rim.
  HeightPlane rim_of(std::span<const geometry::Ring> rings, double& share) const;

  const Mesh& mesh_;
  Eigen::Vector3d origin_;
  geometry::Surface surface_;
  SeenFaces faces_;
  std::vector<float> bends_;  // of the vertices [m]
  double top_ = 0;            // above the highest vertex
};

}  // namespace axial::map
