// SPDX-License-Identifier: GPL-3.0-or-later
// Maps of a mesh: heights and orthomosaics as GeoTIFF.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "axial/base.h"
#include "axial/geometry.h"
#include "axial/scene_images.h"

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

// The normal of the plane that is fitted to the mesh (fitted_plane()), in the direction towards the
// mean of the camera centres `centres` [frame of the mesh]. Errors of fitted_plane() are passed on.
// Error if the camera centres lie in the plane.
Eigen::Vector3d fitted_up(const Mesh& mesh, std::span<const Eigen::Vector3d> centres);

// The median width [m] of a photograph's pixel on the mesh, to choose the pixel of a map. The
// places are `places` points that are spread evenly over the area of the mesh. At each place the
// photograph counts that shows the place best: with the largest product of the area of a piece of
// surface in the image and the squared cosine of the angle between its normal and the path of
// light, which is the measure of TextureMesh. The width is the square root of the area on the
// surface that a pixel shows, as the exact camera projects it. Photographs that other parts of the
// mesh hide from the place count, too. Error if no place is in a photograph that faces it.
double median_pixel_width(const Mesh& mesh, std::span<const geometry::PosedCamera> photos,
                          int places = 2000);

// `width` rounded to two significant digits. Precondition: `width` is above 0.
double rounded_width(double width);

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
// coordinates, so that the pixels of maps with the same `pixel` coincide. Error for a
// side with more than `most` pixels. Precondition: the mesh has faces, and
// `pixel` is above 0.
inline constexpr double kMostPixels = 1'000'000;
MapGrid grid_around(const Mesh& mesh, const MapFrame& frame, double pixel,
                    double most = kMostPixels);

// The coordinate reference system of an EPSG code, as WKT. Error that calls `code` the setting
// "epsg" if PROJ does not know the code, and if the system is not a projected one with
// metres as unit.
std::string crs_of_epsg(int code);

inline constexpr float kNoHeight = -9999;  // of a pixel without surface

// What a map shows. The object refers to data of the caller.
struct MapContent {
  const TexturedMesh& mesh;              // without textures: the map has no colours
  std::span<const std::uint16_t> views;  // for each face the number of views that see it, or empty
  // For each face the expected error of its height [m], kNoHeight: unknown. Or empty.
  std::span<const float> errors;
  MapFrame frame;
  MapGrid grid;
};

struct MapFiles;

// Files that are made from finished maps, such as copies in another format. `write` gets the maps
// and the files `paths` under the names under which they lie at this moment, and writes `paths` in
// place.
struct FurtherFiles {
  std::vector<std::filesystem::path> paths;
  std::function<void(const MapFiles& maps, std::span<const std::filesystem::path> paths)> write;
};

// The files to write. An empty path: the file is not written.
struct MapFiles {
  std::filesystem::path heights;   // GeoTIFF (MapKind::heights)
  std::filesystem::path colors;    // GeoTIFF (MapKind::colors); needs textures
  std::filesystem::path counts;    // GeoTIFF (MapKind::counts); needs MapContent::views
  std::filesystem::path errors;    // GeoTIFF (MapKind::heights); needs MapContent::errors
  std::filesystem::path shades;    // GeoTIFF (MapKind::shades)
  std::filesystem::path contours;  // GeoJSON of write_contours(); needs `heights`
  std::filesystem::path picture;   // JPEG of draw_overview(); needs `colors`
  // GeoPackage and DXF of write_contours(); need `contours`.
  std::filesystem::path contour_package = {}, contour_drawing = {};
  std::vector<FurtherFiles> further = {};

  // All files with a path, in the order of the members.
  std::vector<std::filesystem::path> all() const;
};

struct WriteOptions {
  std::string crs = {};           // WKT; empty: none
  bool is_georeferenced = false;  // y of the map is north, for the arrow in the picture
  LocalFrame mesh_frame = {};     // for the axes that the files state
  int block_size = 512;           // [px]; affects the memory, but not the result
  int samples = 0;                // along each side of a pixel, odd; 0: samples_per_pixel()
  double contour_interval = 0;    // height between contour lines [m]
  int longest_side = 2048;        // of the picture, without its strip [px]
};

struct MapReport {
  std::int64_t surface = 0;  // pixels with a height
  std::int64_t colored = 0;  // pixels with a colour
};

// Makes the maps of `content` block by block, several at the same time, and writes them. All files
// are written under temporary names and then renamed one after the other. If anything fails before
// that, existing files keep their content. The result has the same bytes for any number of threads,
// any size of blocks and any memory. The stages "Maps", "Files" and "Further files" count blocks,
// maps and members of MapFiles::further, whose errors are passed on.
//
// Errors of check_content() are passed on. Error that names the file if it cannot be written, and
// if the memory does not suffice for samples_per_pixel(), and for the lists of faces and one block.
MapReport write_maps(const MapFiles& files, const MapContent& content, const WriteOptions& options,
                     const Context& context = {});

}  // namespace axial::map
