// SPDX-License-Identifier: GPL-3.0-or-later
// Evaluates properties of a mesh besides the distances of evaluate_mesh(): its normals, its surface
// where the cameras saw nothing, and its topology.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "evaluate/cloud_evaluation.h"
#include "evaluate/statistics.h"
#include "evaluate/surface.h"
#include "evaluate/topology.h"
#include "evaluate/views.h"
#include "scene/mesh.h"

namespace axial::evaluate {

inline constexpr std::array<double, 3> kNormalLimits{10, 20, 30};  // [degrees]

// Angles between the normal of the mesh at a sample and the normal of the truth at the nearest
// point, from 0 to 180 degrees. A face whose orientation is opposite to the truth has an angle of
// more than 90 degrees.
struct NormalErrors {
  std::size_t count = 0;  // number of angles; faces without area have none
  double median = 0;      // [degrees]
  std::array<double, kNormalLimits.size()> within{};  // shares of angles up to kNormalLimits
};

// Statistics of the seen samples of the mesh. The place of a sample is the nearest point of the
// truth. A sample is seen if at least CloudOptions::least_views views see its place.
struct SeenPart {
  double share = 0;             // of the area of the mesh
  DistanceStatistics accuracy;  // as CloudEvaluation::accuracy
  std::vector<Score> scores;    // precision of these samples; recall as in CloudEvaluation
  NormalErrors normals;
};

// The area of the mesh that the views do not support, in three disjoint classes. Each number is a
// share of the area of the mesh. The place of a sample is the nearest point of the truth.
struct UnseenArea {
  double no_view = 0;    // no view sees the place
  double few_views = 0;  // some views see the place, but fewer than CloudOptions::least_views
  // Enough views see the place, but the sample is farther from it than CloudEvaluation::gross.
  double far = 0;
  double total() const { return no_view + few_views + far; }
};

struct MeshEvaluation {
  NormalErrors normals;              // of all samples
  std::optional<SeenPart> seen;      // nothing without views
  std::optional<UnseenArea> unseen;  // nothing without views
  Topology topology;
};

// Samples of a mesh, uniform by area, and their faces.
struct MeshSamples {
  std::span<const Eigen::Vector3f> positions;
  std::span<const std::uint32_t> faces;
};

// Evaluates `mesh` by the samples that evaluate_mesh has drawn. `samples`: the outputs `sampled`
// and `faces` of evaluate_mesh. `whole`: the result of evaluate_mesh. `truth`: its argument
// `surface`. The other arguments are the same as for evaluate_mesh. count_views() with `truth`
// decides which views see a place, so the mesh itself hides no place. Errors as for topology_of.
MeshEvaluation evaluate_mesh_parts(const Mesh& mesh, const MeshSamples& samples,
                                   const Surface& truth, std::span<const View> views,
                                   const CloudOptions& options, const CloudEvaluation& whole);

}  // namespace axial::evaluate
