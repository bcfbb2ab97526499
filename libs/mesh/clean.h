// SPDX-License-Identifier: GPL-3.0-or-later
// Mends and simplifies a triangle mesh.
#pragma once

#include <cstddef>

#include "scene/mesh.h"

namespace axial::mesh {

struct CleanOptions {
  double decimate = 1;           // part of the faces to keep, above 0; 1: all
  std::size_t target_faces = 0;  // number of faces to keep, instead of `decimate`; 0: not given
  double spurious = 20;  // remove components with a diameter below this many mean edge lengths
  bool spikes = true;    // remove faces that hang on the mesh by one edge or one corner
  std::size_t close_holes = 30;  // close holes of at most this many edges; 0: none
  unsigned smooth = 0;           // steps of smoothing
  double edge_length = 0;        // length of the edges after remeshing [m]; 0: no remeshing
};

struct CleanReport {
  std::size_t removed_components = 0, removed_spikes = 0, closed_holes = 0;
  std::size_t removed_intersections = 0;  // faces that intersected others to the end
};

// Makes `mesh` edge- and vertex-manifold, oriented and free of self-intersections. The steps, in
// this order: repair of edges and vertices at which more than two faces meet, spurious
// components, simplification, spikes, holes, smoothing, remeshing, and again spikes and holes; at
// last faces that intersect each other are smoothed, and removed if that does not help. Vertices
// without faces are removed. Colours are lost. The result does not depend on the number of threads.
// Error if the mesh has no face, or if no face is left.
Mesh clean(const Mesh& mesh, const CleanOptions& options = {}, CleanReport* report = nullptr);

}  // namespace axial::mesh
