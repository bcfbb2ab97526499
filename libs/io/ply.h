// SPDX-License-Identifier: GPL-3.0-or-later
// PLY clouds and meshes: ascii and binary in, binary little-endian out.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

#include "scene/local_frame.h"
#include "scene/mesh.h"
#include "scene/point_cloud.h"

namespace axial::io {

// Properties are looked up by name (x y z, nx ny nz, red green blue or diffuse_*, view_indices,
// view_weights); legacy (float, uchar) and modern (float32, uint8) type names; unknown elements and
// properties are skipped. Error that names the file for anything malformed or truncated.
// Positions are as stored; of a file with a line "comment geo_offset X Y Z" they count from there.
PointCloud read_cloud_ply(const std::filesystem::path& path);

// The same with positions in `frame`, whatever they count from in the file: moved there before they
// become float.
PointCloud read_cloud_ply(const std::filesystem::path& path, const LocalFrame& frame);

// Where a file's vertices are, and how well it knows that.
struct PlyPlace {
  Eigen::Vector3d first_vertex = Eigen::Vector3d::Zero();  // [world]; zero if there is none
  LocalFrame frame;                                        // that the stored positions count from
  bool is_float = true;                                    // positions are float32
};

// Error as read_cloud_ply for a header, or a first vertex, that is none.
PlyPlace ply_place(const std::filesystem::path& path);

// The place of positions that are written.
struct PlyPlacement {
  LocalFrame frame;    // that they are in; unless it is the world, a comment geo_offset names it
  bool world = false;  // write them as float64 in world coordinates, without such a comment
};

// What every point of a cloud has besides its position.
struct CloudLayout {
  bool colors = false, normals = false, views = false, view_weights = false;
  bool errors = false;  // the expected error and the confidence
};

// A cloud written portion by portion, of any size. The file takes its name in finish(); until then,
// and if that is never called, there is none. Layout as OpenMVS writes it: x y z, red green blue,
// nx ny nz, view_indices, view_weights; then error and confidence, of ours. The number of points is
// known last, so a comment line keeps the room that its digits do not need.
class CloudWriter {
 public:
  CloudWriter(const std::filesystem::path& path, const CloudLayout& layout,
              const PlyPlacement& placement = {});
  ~CloudWriter();
  CloudWriter(CloudWriter&&) = delete;

  // Appends all points of `portion`. Error that names the file if an array of the layout is missing
  // or has another length than the positions, if a point has more than 255 views (the format counts
  // in a byte), or if the file cannot be written.
  void add(const PointCloud& portion);

  std::size_t size() const;  // points so far

  void finish();

 private:
  struct File;
  std::unique_ptr<File> file_;
};

// The whole cloud at once, each group of the layout only where the cloud has it. Errors as
// CloudWriter::add.
void write_cloud_ply(const std::filesystem::path& path, const PointCloud& cloud,
                     bool with_views = true, const PlyPlacement& placement = {});

// Faces of more than three corners are split into a fan. Error for a face index out of range.
// Positions as read_cloud_ply.
Mesh read_mesh_ply(const std::filesystem::path& path);
Mesh read_mesh_ply(const std::filesystem::path& path, const LocalFrame& frame);

void write_mesh_ply(const std::filesystem::path& path, const Mesh& mesh,
                    const PlyPlacement& placement = {});

// What the writers make of a placement, for files with further properties: the comment line that
// says where positions count from (empty in the world), the header's lines of the position, and the
// bytes of a position.
std::string geo_comment(const PlyPlacement& placement);
const char* position_properties(const PlyPlacement& placement);
void append_position(std::string& bytes, const Eigen::Vector3f& position,
                     const PlyPlacement& placement);

// True if the header declares a non-empty face element.
bool ply_has_faces(const std::filesystem::path& path);

}  // namespace axial::io
