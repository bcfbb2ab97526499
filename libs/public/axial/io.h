// SPDX-License-Identifier: GPL-3.0-or-later
// The files of a scene, and PLY files of clouds and meshes: reads ascii and binary files, writes
// binary little-endian files.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>

#include "axial/base.h"
#include "axial/scene.h"

namespace axial::io {

// Which ports the cameras of a scene get.
enum class PortChoice {
  automatic,  // the ports of the housing file, if there is one
  ignored,    // the housing file is not read
  required,   // a housing file must exist and give at least one image a port
  flat        // a housing file must exist and give every calibrated image a flat port
};

// The files of a scene. The paths are absolute. Messages name four settings: "allow_missing",
// "housing", "refractive" (PortChoice::required) and "camera is flat_port" (PortChoice::flat).
struct SceneFiles {
  std::filesystem::path scene;           // the .mvs file
  std::filesystem::path working_folder;  // relative image paths in the scene start here
  std::filesystem::path housing;         // empty: the housing file beside the scene, if any
  PortChoice ports = PortChoice::automatic;
  bool allow_missing = false;  // true: warn if `housing` gives no image a port, instead of an Error
};

// A decoded photograph.
struct Photograph {
  cv::Mat pixels;    // B G R, CV_8UC3 or CV_16UC3
  cv::Mat1b opaque;  // 0: fully transparent, 255: other; empty: no pixel is fully transparent
};

// Reads a cloud. Properties are recognised by their names: x y z, nx ny nz, red green blue (or
// diffuse_red and so on), view_indices, view_weights. Old (float, uchar) and new (float32, uint8)
// names of types are accepted. Other elements and properties are skipped. Arrays of the result are
// empty where the file has no such property. Colours are clamped to 0 to 255. Error and confidence
// of points are not read.
//
// Positions are returned as stored. If the file has a line "comment geo_offset X Y Z", the stored
// positions are relative to the point X Y Z. Otherwise the file does not state their origin.
//
// Error that names the file for a malformed or truncated file, vertices without x, y or z, or a
// position or normal that is not finite.
PointCloud read_cloud_ply(const std::filesystem::path& path);

// Reads a cloud and returns its positions in `frame`. The origin of the stored positions is the
// point in the file's comment geo_offset, or the world's origin if there is no such comment. The
// positions are moved in double precision and then rounded to float.
PointCloud read_cloud_ply(const std::filesystem::path& path, const LocalFrame& frame);

// How positions are written. If `world` is true, positions are written as float64 in world
// coordinates. Otherwise positions are written as float32 in `frame`, and a comment geo_offset
// states the origin of `frame` unless `frame` is the world.
struct PlyPlacement {
  LocalFrame frame;    // of the positions in memory
  bool world = false;  // see above
};

// Writes a whole cloud and replaces an existing file. The file has the properties whose arrays in
// `cloud` are not empty, with one exception: view_indices and view_weights are written only if
// `with_views` is true. Error that names the file
// if an array does not match the number of points, if a point has more than 255 views (the format
// counts views in a byte), or if the file cannot be written.
void write_cloud_ply(const std::filesystem::path& path, const PointCloud& cloud,
                     bool with_views = true, const PlyPlacement& placement = {});

// Read a mesh. Faces with more than three corners are split into a fan of triangles. Strips in an
// element tristrips become triangles. The property unseen of the faces, if there is one, becomes
// Mesh::unseen: 0 stays 0, and other numbers become 1. Positions are returned as by the function
// read_cloud_ply with the same parameters. Error that names the file for a file without an element
// face or tristrips, a face with fewer than three corners, or a vertex index out of range. Other
// errors as for read_cloud_ply.
Mesh read_mesh_ply(const std::filesystem::path& path);
Mesh read_mesh_ply(const std::filesystem::path& path, const LocalFrame& frame);

// Writes a mesh, with its colours and the property unseen of its faces (uint8) if it has them, and
// replaces an existing file. Error that names the file if the number of colours is neither 0 nor
// the number of vertices, if the number of marks is neither 0 nor the number of faces, or if the
// file cannot be written. Vertex indices are not checked.
void write_mesh_ply(const std::filesystem::path& path, const Mesh& mesh,
                    const PlyPlacement& placement = {});

}  // namespace axial::io
