// SPDX-License-Identifier: GPL-3.0-or-later
// The axes of a map and its pixel grid.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "base/setting_names.h"
#include "scene/local_frame.h"
#include "scene/mesh.h"

namespace axial::map {

// The frame of a map: x to the right, y to the top of the map, z (height) towards the viewer. All
// lengths are in metres. A georeferenced map has x = east and y = north.
struct MapFrame {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  // rows: x, y and z in the frame of the mesh
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();    // the origin of the mesh's frame [map]

  // The map coordinates of the point `x` in the frame of the mesh.
  Eigen::Vector3d to_map(const Eigen::Vector3d& x) const { return axes * x + origin; }
};

// The map whose height axis is `up` [frame of the mesh, not 0, of any length]. Let u be `up` with
// the length 1. The map's x axis is the projection of the world's x axis onto the plane normal to
// u, or the projection of the world's y axis if u is less than 45 degrees from the world's x axis
// or from its opposite. The map's y axis is the vector product of u and the map's x axis. So with
// `up` = (0, 0, 1) the map has the axes of the world. The origin of the map is the origin of the
// world. Exception: with other axes, heights are measured from the origin of the mesh's frame,
// because a height of millions of metres has no millimetres in single precision. `mesh_frame`: the
// frame of the mesh.
MapFrame frame_with_up(const Eigen::Vector3d& up, const LocalFrame& mesh_frame);

// The plane that is fitted to a mesh.
struct FittedPlane {
  Eigen::Vector3d point;   // the centroid of the surface [frame of the mesh]
  Eigen::Vector3d normal;  // unit; either of the two directions
};

// The plane that is fitted to the mesh by least squares of the distances of all points of its
// surface, weighted by area. Faces far away are left out, because they would tilt the plane: those
// that are more than five times farther from the median of the surface than half of its area is, if
// they have at most 2 % of the area and if the plane without them is another one. Error for a mesh
// whose area is 0.
FittedPlane fitted_plane(const Mesh& mesh);

// The normal of fitted_plane() in the direction towards the mean of the camera centres `centres`
// [frame of the mesh]. Errors of fitted_plane() are passed on. Error if the camera centres lie in
// the plane.
Eigen::Vector3d fitted_up(const Mesh& mesh, std::span<const Eigen::Vector3d> centres);

// The pixels of a map. Pixel (column, row) covers the square from (left + column * pixel, top - row
// * pixel) to (left + (column + 1) * pixel, top - (row + 1) * pixel) [map]. Its centre is the
// middle of this square, and all values of the pixel but its colour belong to the centre.
struct MapGrid {
  double left = 0, top = 0;  // the upper left corner of the upper left pixel [map, m]
  double pixel = 1;          // width of a pixel, the ground sample distance [m]
  int columns = 0, rows = 0;

  std::int64_t pixels() const { return std::int64_t{columns} * rows; }
  // The place at the height `height` over the centre of the pixel in column x of row y [map, m].
  Eigen::Vector3d centre(int y, int x, double height) const {
    return {left + (x + 0.5) * pixel, top - (y + 0.5) * pixel, height};
  }
};

// The smallest grid that contains all faces of the mesh up to a thousandth of a pixel, because
// vertices are rounded to float. The corners of the grid are at multiples of `pixel` in map
// coordinates, so that the pixels of maps with the same `pixel` coincide. Error of
// require_possible() for a side with more than `most` pixels. Precondition: the mesh has faces, and
// `pixel` is above 0.
inline constexpr double kMostPixels = 1'000'000;
MapGrid grid_around(const Mesh& mesh, const MapFrame& frame, double pixel,
                    SettingNames name_of = own_name, double most = kMostPixels);

// Throws an Error if a side of a map has more than `most` pixels. The message calls the width of a
// pixel by name_of("ground_sample_distance").
void require_possible(double columns, double rows, double pixel, SettingNames name_of,
                      double most = kMostPixels);

// The coordinate reference system of an EPSG code, as WKT. Error that calls `code` by
// name_of("epsg") if PROJ does not know the code, and if the system is not a projected one with
// metres as unit.
std::string crs_of_epsg(int code, SettingNames name_of = own_name);

}  // namespace axial::map
