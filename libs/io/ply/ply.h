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

#include "axial/io.h"

namespace axial::io {

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
