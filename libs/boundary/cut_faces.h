// SPDX-License-Identifier: GPL-3.0-or-later
// Splits the faces of a mesh along a boundary, so that each face is on one side of it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "boundary/boundary.h"
#include "scene/mesh.h"

namespace axial::boundary {

// A part of a face that was split. Its corners have the direction of those of the face.
struct Piece {
  std::array<std::uint32_t, 3> corners;
  Eigen::Matrix3f weights;  // column k: the weights of the face's corners at corner k
  bool outside = false;
};

// The faces of a mesh on both sides of a boundary.
struct CutFaces {
  static constexpr std::uint32_t kWhole = 0xFFFFFFFFu;

  std::vector<std::uint8_t> outside;    // one per face of the mesh, for faces that stay whole
  std::vector<std::uint32_t> split_at;  // one per face: index in `splits`; kWhole
  std::vector<std::vector<Piece>> splits;
  // The vertices that splitting adds, after those of the mesh, and their colours.
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Rgb> colors;  // empty without colours
};

// Where the boundary crosses an edge, both faces get the same vertex, so that a closed mesh stays
// closed before the outer faces are removed. The surface stays the same. Corners of the boundary
// become vertices. A face that the boundary only touches, up to kSame, stays whole. Upright faces
// are split, too. The result does not depend on the number of threads. Precondition: check_mesh()
// accepts the mesh. Error for a face that more than 10,000 sides of the boundary may cross.
CutFaces cut_faces(const Mesh& mesh, const Boundary& boundary);

// The memory [bytes] of cut_faces() with its result, if few faces are split.
std::uint64_t bytes_to_cut(const Mesh& mesh);

}  // namespace axial::boundary
