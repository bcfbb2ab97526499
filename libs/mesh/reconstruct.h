// SPDX-License-Identifier: GPL-3.0-or-later
// The entry of this library: from a cloud with views to a mesh. The steps are those of Labatut,
// Pons and Keriven 2009 (votes.h), with rays that bend at the ports of the cameras.
#pragma once

#include <cstdint>

#include "base/setting_names.h"
#include "mesh/clean.h"
#include "mesh/merge_points.h"
#include "mesh/votes.h"
#include "scene/mesh.h"
#include "scene/point_cloud.h"
#include "scene/scene.h"

namespace axial::mesh {

struct ReconstructOptions {
  MergeOptions merge;
  VoteOptions votes;
  // `spurious` also limits the edges of the surface (surface.h).
  CleanOptions clean;
  bool only_region = false;         // use only points in the scene's region of interest
  bool crop_to_region = true;       // remove the surface outside of the region, if there is one
  std::uint64_t max_bytes = 0;      // 0: no limit
  SettingNames name_of = own_name;  // "max_memory", "merge.min_distance"
};

// The memory that reconstruct() needs besides the cloud, for this number of merged points [bytes].
std::uint64_t bytes_needed(std::size_t merged_points);

// Reconstructs the surface that the images of `scene` see in `cloud`. The result is in the frame of
// scene and cloud, oriented, manifold and free of self-intersections; parts of the surface without
// points are left out. The cloud is freed when its points are merged. Logs each step.
// Error for a cloud without views, for a view that is not a calibrated image of the scene, for a
// position that is not finite, for a weight that is not from 0 to 1e6, for fewer than four points
// that are not in a plane, and if bytes_needed() exceeds max_bytes. The same result for any number
// of threads.
Mesh reconstruct(PointCloud cloud, const Scene& scene, const ReconstructOptions& options = {});

}  // namespace axial::mesh
