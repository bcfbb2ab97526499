// SPDX-License-Identifier: GPL-3.0-or-later
// The boundary of a survey: polygons on a map, outside of which results are left out.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "boundary/options.h"
#include "geometry/polygon_pieces.h"
#include "map/world_axes.h"
#include "scene/local_frame.h"

namespace axial::boundary {

// Polygons in the plane of a map, and how points of a mesh get there. A point is inside if it is in
// one of the polygons, whatever its height.
class Boundary {
 public:
  using Polygon = std::vector<geometry::Ring>;  // the outer ring and the holes

  // `polygons`: on a map with the axes `axes` [map, m], at least one, each as for
  // geometry::PolygonPieces. `mesh_frame`: of the points of contains(). `name`: of the polygons, in
  // messages.
  Boundary(std::vector<Polygon> polygons, const map::WorldAxes& axes, const LocalFrame& mesh_frame,
           std::string name);

  const std::string& name() const { return name_; }
  // The polygons, in places of plan_of().
  const std::vector<Polygon>& polygons() const { return polygons_; }

  // The place of a point of the mesh in the plane of the map, from a place near the mesh [m].
  Eigen::Vector2d plan_of(const Eigen::Vector3d& in_mesh_frame) const {
    return plan_ * in_mesh_frame;
  }
  bool contains(const Eigen::Vector2d& plan) const;

  // The extent of the polygons [map].
  Eigen::AlignedBox2d extent() const;
  // The same for a place on the map [m].
  bool contains_on_map(const Eigen::Vector2d& place) const { return contains(place - origin_); }
  // The place on the map [m] of a place of plan_of().
  Eigen::Vector2d on_map(const Eigen::Vector2d& plan) const { return plan + origin_; }

 private:
  std::vector<Polygon> polygons_;
  std::vector<geometry::PolygonPieces> pieces_;
  Eigen::Matrix<double, 2, 3> plan_;
  Eigen::Vector2d origin_;
  std::string name_;
};

// Reads the boundary that `options` state. `axes`, `crs`: of the map on which it is meant (crs:
// WKT; empty: none). `mesh`: the file of the mesh, beside which places of targets are looked for.
// Errors of map::read_areas() and places_of_targets() are passed on. Error for targets whose
// outline crosses itself in the order of the labels, and if there is no file of their places.
Boundary read_boundary(const Options& options, const map::WorldAxes& axes, const std::string& crs,
                       const LocalFrame& mesh_frame, const std::filesystem::path& mesh);

// Reads the files of `options` to find faults before long work, as far as they do not depend on the
// axes. `crs`: as for read_boundary(), if Options::map does not state it. Errors as for
// read_boundary().
void check_files(const Options& options, const std::filesystem::path& mesh,
                 const std::string& crs = {});

// For programs that make a map: the axes of Options::map, and its coordinate reference system (WKT)
// in place of `crs`. Nothing if it is not given. Errors of map::place_of_map() are passed on.
std::optional<map::WorldAxes> take_map(const Options& options, std::string& crs);

}  // namespace axial::boundary
