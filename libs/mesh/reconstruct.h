// SPDX-License-Identifier: GPL-3.0-or-later
// The entry of this library: makes a mesh from a cloud with views. The method is that of Labatut,
// Pons and Keriven 2009 (votes.h). In addition, the rays of cameras behind ports bend at the port.
#pragma once

#include <cstdint>

#include "base/context.h"
#include "base/setting_names.h"
#include "mesh/clean.h"
#include "mesh/merge_points.h"
#include "mesh/votes.h"
#include "scene/mesh.h"
#include "scene/point_cloud.h"
#include "scene/scene.h"

namespace axial::mesh {

// Options of reconstruct().
struct ReconstructOptions {
  MergeOptions merge;
  VoteOptions votes;
  // `clean.spurious` has a second effect: it is the `factor` of surface_without_long_edges()
  // (surface.h).
  CleanOptions clean;
  bool only_region = false;    // use only points in Scene::region, if there is one
  bool crop_to_region = true;  // remove faces with a corner outside of Scene::region, if any
  // Errors name merge.min_distance by name_of("merge.min_distance"), and the number of tiles
  // (tiled.h) by name_of("tiles").
  SettingNames name_of = own_name;
};

// The approximate memory [bytes] that reconstruct() needs for `merged_points` points that
// merge_points() returns. The memory of the cloud, which is freed before, is not included.
std::uint64_t bytes_needed(std::size_t merged_points);

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
// * bytes_needed() exceeds the limit of Context::memory(),
// * no surface is found, or clean() throws (clean.h).
Mesh reconstruct(PointCloud cloud, const Scene& scene, const ReconstructOptions& options = {},
                 const Context& context = {});

// The steps of reconstruct(), for clouds that are reconstructed in tiles (tiled.h).
//
// Throws the Errors of reconstruct() for a point whose position, views or weights are wrong. The
// points of `cloud` have the numbers from `first` on in messages.
void check_points(const PointCloud& cloud, const Scene& scene, std::size_t first = 0);
// Makes the mesh of points that are merged already. `rays`: of the same scene. The result has no
// faces if there are fewer than four points, if no surface is found, or if cleaning leaves no face.
// Throws an Error if bytes_needed() exceeds the limit of Context::memory(), or if all points lie in
// a plane.
Mesh reconstruct_merged(MergedPoints points, const Scene& scene, const ViewRays& rays,
                        const ReconstructOptions& options, const Context& context = {});

}  // namespace axial::mesh
