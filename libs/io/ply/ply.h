// SPDX-License-Identifier: GPL-3.0-or-later
// PLY clouds and meshes: reads ascii and binary files, writes binary little-endian files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "scene/local_frame.h"
#include "scene/mesh.h"
#include "scene/point_cloud.h"

namespace axial::io {

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

// Receives a portion of a cloud, and the number of points of the whole cloud.
using CloudPortionSink = std::function<void(PointCloud portion, std::size_t all_points)>;

// Reads a cloud of any size in portions. Calls `sink` with portions of `points` points each, in the
// order of the file; the last portion may be smaller. Properties, positions and Errors are those of
// the function read_cloud_ply() with the same frame; null: the function without a frame. In
// addition, rows of more than 1 MB and ascii files with lines of more than 32 MB are refused. Data
// behind the vertices are not read. If an Error is found in a portion, `sink` has received the
// portions before. Needs at most 32 MB, besides the portion. Precondition: `points` is at least 1.
void read_cloud_portions(const std::filesystem::path& path, const LocalFrame* frame,
                         std::size_t points, const CloudPortionSink& sink);

// Where the positions of a file are, and their precision.
struct PlyPlace {
  // The stored first vertex plus the origin of `frame` below; zero if the file has no vertices.
  Eigen::Vector3d first_vertex = Eigen::Vector3d::Zero();
  LocalFrame frame;      // from the comment geo_offset; the world if there is no such comment
  bool is_float = true;  // true: x is float32, or there are no vertices; false: another type
};

// Returns the place of the positions of a file. Only the header and the first vertex are
// interpreted. Errors as for read_cloud_ply().
PlyPlace ply_place(const std::filesystem::path& path);

// How positions are written. If `world` is true, positions are written as float64 in world
// coordinates. Otherwise positions are written as float32 in `frame`, and a comment geo_offset
// states the origin of `frame` unless `frame` is the world.
struct PlyPlacement {
  LocalFrame frame;    // of the positions in memory
  bool world = false;  // see above
};

// The properties that a file of a cloud has for each point besides its position. `views` stands for
// view_indices.
struct CloudLayout {
  bool colors = false, normals = false, views = false, view_weights = false;
  bool errors = false;  // both properties, error and confidence
};

// Writes a cloud of any size in portions. finish() renames a temporary file to `path`. If finish()
// is not called, the destructor removes the temporary file, and an existing file at `path` stays as
// it is. The order of the properties is that of OpenMVS: x y z, red green blue, nx ny nz,
// view_indices, view_weights. The properties error and confidence, which OpenMVS does not have,
// follow. The number of points is known only at the end. The header therefore contains a comment
// line with blanks that reserve room for the digits of this number.
class CloudWriter {
 public:
  // Opens the temporary file. Error if it cannot be written. Precondition: `layout.view_weights` is
  // true only with `layout.views`.
  CloudWriter(const std::filesystem::path& path, const CloudLayout& layout,
              const PlyPlacement& placement = {});
  ~CloudWriter();
  CloudWriter(CloudWriter&&) = delete;

  // Appends all points of `portion`. Error that names the file if an array that the layout demands
  // is missing or does not match the number of points, if a point has more than 255 views (the
  // format counts views in a byte), or if the file cannot be written.
  void add(const PointCloud& portion);

  // Appends all points of a file of `points` points, which a CloudWriter with the same layout and
  // placement wrote. The bytes are copied as they are. Error that names the file if it cannot be
  // read or if its header is another one.
  void add_file(const std::filesystem::path& written, std::size_t points);

  std::size_t size() const;  // number of points added so far

  // Writes the number of points into the header and renames the temporary file. Call it once, after
  // the last add(). Error if the file cannot be written.
  void finish();

 private:
  struct File;
  std::unique_ptr<File> file_;
};

// Writes a whole cloud and replaces an existing file. The file has the properties whose arrays in
// `cloud` are not empty, with one exception: view_indices and view_weights are written only if
// `with_views` is true. Errors as for CloudWriter::add.
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

// Functions for writers of other PLY files. All positions are placed as `placement` demands.
// geo_comment returns the header line "comment geo_offset X Y Z" with its newline, or an empty text
// if `placement.world` is true or `placement.frame` is the world. position_properties returns the
// header lines of x, y and z. append_position appends the bytes of one position, which is given in
// `placement.frame`, to `bytes`.
std::string geo_comment(const PlyPlacement& placement);
const char* position_properties(const PlyPlacement& placement);
void append_position(std::string& bytes, const Eigen::Vector3f& position,
                     const PlyPlacement& placement);

// True if the header declares an element face or tristrips with at least one row. Error that names
// the file for a malformed header.
bool ply_has_faces(const std::filesystem::path& path);

// Reads the property `name` of the vertices. Returns one value for each vertex, in the order of the
// file, converted from the type in the file. The result is empty if the vertices have no property
// of this name, or if the property is a list. Error that names the file for a malformed file, and
// for one that is truncated before the end of its vertices.
std::vector<float> read_vertex_property(const std::filesystem::path& path, const std::string& name);

// A property to write.
struct VertexProperty {
  std::string name;               // without blanks
  std::span<const float> values;  // one for each vertex
};

// Writes a mesh as write_mesh_ply in ply.h does, and adds one float property to the vertices.
// Errors as for that function. In addition, an Error if the number of values differs from the
// number of vertices.
void write_mesh_ply(const std::filesystem::path& path, const Mesh& mesh,
                    const VertexProperty& property, const PlyPlacement& placement = {});

}  // namespace axial::io
