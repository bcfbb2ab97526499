// SPDX-License-Identifier: GPL-3.0-or-later
// Judges a mesh beyond the distances of evaluate_mesh: its normals, its surface where the cameras
// saw nothing, and its topology.
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

// Angles between the normal of the mesh and the normal of the truth, from 0 to 180 degrees: a face
// that shows its back has more than 90.
struct NormalErrors {
  std::size_t count = 0;
  double median = 0;                                  // [degrees]
  std::array<double, kNormalLimits.size()> within{};  // shares of angles up to kNormalLimits
};

// The part of the mesh over surface that the cameras saw: samples whose place is seen by enough
// views. The place of a sample is the nearest point of the truth.
struct SeenPart {
  double share = 0;             // of the area of the mesh
  DistanceStatistics accuracy;  // as CloudEvaluation::accuracy
  std::vector<Score> scores;    // precision of these samples; recall as in CloudEvaluation
  NormalErrors normals;
};

// Shares of the area of the mesh over unseen space. No share counts an area twice.
struct UnseenArea {
  double no_view = 0;    // no view sees the place
  double few_views = 0;  // some views see it, but fewer than CloudOptions::least_views
  double far = 0;        // enough views see it, but it is farther away than CloudEvaluation::gross
  double total() const { return no_view + few_views + far; }
};

struct MeshEvaluation {
  NormalErrors normals;              // of all samples
  std::optional<SeenPart> seen;      // with cameras
  std::optional<UnseenArea> unseen;  // with cameras
  Topology topology;
};

// Samples of a mesh, uniform by area, and their faces.
struct MeshSamples {
  std::span<const Eigen::Vector3f> positions;
  std::span<const std::uint32_t> faces;
};

// Evaluates `mesh` by the samples that evaluate_mesh has drawn. `whole`: its result. Other
// arguments are those of evaluate_mesh. A view that sees a place is one of count_views with the
// truth as the surface: no surface of the mesh hides it. Errors as for topology_of.
MeshEvaluation evaluate_mesh_parts(const Mesh& mesh, const MeshSamples& samples,
                                   const Surface& truth, std::span<const View> views,
                                   const CloudOptions& options, const CloudEvaluation& whole);

}  // namespace axial::evaluate
