// SPDX-License-Identifier: GPL-3.0-or-later
// Mends and simplifies a triangle mesh.
#pragma once

#include <cstddef>
#include <cstdint>

#include "scene/mesh.h"

namespace axial::mesh {

// What clean() does. The steps are those of the comment of clean().
struct CleanOptions {
  double decimate = 1;           // fraction of the faces to keep in step 3, above 0; 1: all
  std::size_t target_faces = 0;  // number of faces to keep in step 3; 0: `decimate` decides
  // Steps 2 and 8 remove connected components whose bounding box has a diagonal below this many
  // mean edge lengths of the mesh in step 2; 0: none.
  double spurious = 20;
  bool spikes = true;            // remove faces that hang on the mesh by one edge or one corner
  std::size_t close_holes = 30;  // close holes with a border of at most this many edges; 0: none
  unsigned smooth = 0;           // number of smoothing steps in step 5; 0: none
  double edge_length = 0;        // length of the edges after remeshing [m]; 0: no remeshing
  // Step 8 removes the pieces that step 7 cut off and whose bounding box has a diagonal below this
  // many mean edge lengths of the mesh in step 8; 0: none.
  double cut_off = 20;
  bool may_be_empty = false;  // return a mesh without faces instead of an Error if no face is left
};

// What clean() did.
struct CleanReport {
  // Numbers of components, of faces, and of holes.
  std::size_t removed_components = 0, removed_spikes = 0, closed_holes = 0;
  std::size_t removed_intersections = 0;  // faces removed in step 7
};

// Returns a copy of `mesh` that is edge- and vertex-manifold, oriented and free of
// self-intersections. The steps, in this order:
//
//   1. repair of edges and vertices that are not manifold; of faces that repeat the corners of
//      another face, one is kept,
//   2. removal of spurious components,
//   3. simplification,
//   4. removal of spikes, and closing of holes,
//   5. smoothing,
//   6. remeshing and step 4 again, if `edge_length` is above 0,
//   7. smoothing of faces that intersect each other, and removal of these faces if smoothing does
//      not help,
//   8. removal of small pieces that step 7 cut off; the largest piece of each component stays. Then
//      removal of all components that are below the limit of step 2.
//
// Vertices at the same place are moved apart: each moves by 1 % of the way to the mean of its
// neighbours. Vertices without faces are removed. Colours are lost. `report` is overwritten; null:
// no report. Precondition: the corners of all faces are indices into the vertices. The result does
// not depend on the number of threads. Throws an Error if no face of `mesh` has three different
// vertices, if the steps leave no face (unless `may_be_empty`), if a mesh without area shall be
// remeshed, or if remeshing would make more than 2^28 faces.
Mesh clean(const Mesh& mesh, const CleanOptions& options = {}, CleanReport* report = nullptr);

// An estimate of the memory [bytes] of clean() with its result, besides `mesh`, if the mesh is not
// remeshed to more vertices.
std::uint64_t bytes_to_clean(std::uint64_t vertices);

}  // namespace axial::mesh
