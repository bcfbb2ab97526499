// SPDX-License-Identifier: GPL-3.0-or-later
// PLY clouds and meshes: reads ascii and binary files, writes binary little-endian files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

#include "scene/local_frame.h"
#include "scene/mesh.h"
#include "scene/point_cloud.h"

namespace axial::io {

// Reads a cloud. Properties are found by name: x y z, nx ny nz, red green blue (or diffuse_red and
// so on), view_indices, view_weights. Old (float, uchar) and new (float32, uint8) type names are
// known. Other elements and properties are skipped. Error that names the file for a malformed or
// truncated file.
//
// Positions are returned as stored. In a file with a line "comment geo_offset X Y Z" they are
// relative to that point.
PointCloud read_cloud_ply(const std::filesystem::path& path);

// Reads a cloud with positions in `frame`. The positions are moved from the file's own origin in
// double, before they become float.
PointCloud read_cloud_ply(const std::filesystem::path& path, const LocalFrame& frame);

// The origin and the precision of a file's positions.
struct PlyPlace {
  Eigen::Vector3d first_vertex = Eigen::Vector3d::Zero();  // [world]; zero if there is none
  LocalFrame frame;                                        // origin of the stored positions
  bool is_float = true;                                    // positions are float32
};

// Reads the header and the first vertex. Errors as for read_cloud_ply.
PlyPlace ply_place(const std::filesystem::path& path);

// How positions are written.
struct PlyPlacement {
  LocalFrame frame;    // of the positions; a comment geo_offset names it unless it is the world
  bool world = false;  // write float64 in world coordinates, without the comment
};

// The properties that every point of a cloud has besides its position.
struct CloudLayout {
  bool colors = false, normals = false, views = false, view_weights = false;
  bool errors = false;  // the expected error and the confidence
};

// Writes a cloud of any size in portions. The file gets its name in finish(); without finish() no
// file remains. The layout is OpenMVS's: x y z, red green blue, nx ny nz, view_indices,
// view_weights. Our own error and confidence follow. The number of points is known only at the end,
// so the header reserves room for its digits in a comment line.
class CloudWriter {
 public:
  CloudWriter(const std::filesystem::path& path, const CloudLayout& layout,
              const PlyPlacement& placement = {});
  ~CloudWriter();
  CloudWriter(CloudWriter&&) = delete;

  // Appends all points of `portion`. Error that names the file if an array of the layout is missing
  // or has another length than the positions, if a point has more than 255 views (the format counts
  // them in a byte), or if the file cannot be written.
  void add(const PointCloud& portion);

  std::size_t size() const;  // points so far

  // Writes the number of points and gives the file its name. Error if the file cannot be written.
  void finish();

 private:
  struct File;
  std::unique_ptr<File> file_;
};

// Writes a whole cloud with the properties that it has; view_indices and view_weights only if
// `with_views`. Errors as for CloudWriter::add.
void write_cloud_ply(const std::filesystem::path& path, const PointCloud& cloud,
                     bool with_views = true, const PlyPlacement& placement = {});

// Read a mesh. Faces with more than three corners are split into a fan of triangles. Positions are
// treated as in read_cloud_ply. Error for a face index out of range, and as for read_cloud_ply.
Mesh read_mesh_ply(const std::filesystem::path& path);
Mesh read_mesh_ply(const std::filesystem::path& path, const LocalFrame& frame);

// Writes a mesh with its colours, if it has any. Error if there is not one colour for each vertex.
void write_mesh_ply(const std::filesystem::path& path, const Mesh& mesh,
                    const PlyPlacement& placement = {});

// Parts of a file for writers of other properties: the comment line with the origin of the
// positions (empty for the world), the header lines of the position, and the bytes of one position.
std::string geo_comment(const PlyPlacement& placement);
const char* position_properties(const PlyPlacement& placement);
void append_position(std::string& bytes, const Eigen::Vector3f& position,
                     const PlyPlacement& placement);

// True if the header declares a non-empty face element.
bool ply_has_faces(const std::filesystem::path& path);

}  // namespace axial::io
