// SPDX-License-Identifier: GPL-3.0-or-later
// Makes a mesh from a cloud with views, by the method of Labatut, Pons and Keriven 2009; the rays
// of cameras behind ports bend at the port. Mends and simplifies meshes.
#pragma once

#include <cstddef>
#include <cstdint>

#include "axial/base.h"
#include "axial/scene.h"

namespace axial::mesh {

// How neighbouring points are merged.
struct MergeOptions {
  // A point p absorbs another point q only if their images are at most this far apart [px] in every
  // view of p. 0: no points are merged.
  double min_distance = 2.5;
  // If there are more merged points than this, they are counted but not kept. 0: no limit.
  std::size_t most_points = 0;
};

// How the rays of the points vote for free and occupied space.
struct VoteOptions {
  bool constant_weight =
      true;  // the weight of every view is 1; false: the number of points that were merged
  bool weak_support = false;    // also reconstruct surfaces that few points support
  double thickness_factor = 1;  // expected error of a point, in units of 2.5 pixel widths
  double quality_factor = 1;    // factor of the cost of badly shaped facets; 0: none
};

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

// Options of reconstruct().
struct ReconstructOptions {
  MergeOptions merge;
  VoteOptions votes;
  // `clean.spurious` has a second effect: faces are left out whose longest edge is longer than a
  // third of this many median longest edges, where no camera has seen a surface.
  CleanOptions clean;
  bool only_region = false;    // use only points in Scene::region, if there is one
  bool crop_to_region = true;  // remove faces with a corner outside of Scene::region, if any
};

// Reconstructs the surface that the images of `scene` see in `cloud`. The views of the cloud are
// indices into Scene::images. The result is in the frame of scene and cloud, oriented, manifold and
// free of self-intersections. Parts of the surface without points are left out. The cloud is freed
// when its points are merged. `context` gets the result of each step. The result is the same for
// any number of threads. Throws an Error in these cases:
//
// * the cloud has no points or no views,
// * a view is not a calibrated image of the scene,
// * a position is not finite, or a weight is not from 0 to 1e6,
// * fewer than four points remain after merging, or all points lie in a plane,
// * the memory needed exceeds the limit of Context::memory(),
// * no surface is found, or clean() throws.
Mesh reconstruct(PointCloud cloud, const Scene& scene, const ReconstructOptions& options = {},
                 const Context& context = {});

}  // namespace axial::mesh
