// SPDX-License-Identifier: GPL-3.0-or-later
// Evaluates properties of a mesh besides the distances of evaluate_mesh() (cloud_evaluation.h): its
// normals, its surface where the cameras saw nothing, and its topology.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "evaluate/cloud_evaluation.h"
#include "evaluate/statistics.h"
#include "evaluate/topology.h"
#include "evaluate/views.h"
#include "geometry/surface.h"
#include "scene/mesh.h"

namespace axial::evaluate {

// Limits of the angles in NormalErrors::within [degrees].
inline constexpr std::array<double, 3> kNormalLimits{10, 20, 30};

// Statistics of the angles between two normals, from 0 to 180 degrees. The first normal is that of
// the face of the mesh on which a sample lies. The second normal is that of the face of the truth
// that is nearest to the sample. A face whose orientation is opposite to the truth has an angle of
// more than 90 degrees.
struct NormalErrors {
  std::size_t count = 0;  // number of angles; a sample has none if either face has no area
  double median = 0;      // [degrees]; 0 without angles
  // within[k]: share of the angles that are at most kNormalLimits[k]; 0 without angles.
  std::array<double, kNormalLimits.size()> within{};
};

// Statistics of the seen samples of the mesh. The place of a sample is the nearest point of the
// truth. A sample is seen if at least CloudOptions::least_views views see its place.
struct SeenPart {
  double share = 0;             // number of seen samples / number of all samples of the mesh
  DistanceStatistics accuracy;  // of the distances from the seen samples to the truth [m]
  // One score for each of CloudOptions::tolerances. Precision is that of the seen samples. Recall
  // is that of CloudEvaluation::scores.
  std::vector<Score> scores;
  NormalErrors normals;  // of the seen samples
};

// The area of the mesh that the views do not support, in three disjoint classes. Each number is the
// share of the samples of the mesh in the class, which estimates a share of the area of the mesh.
// The place of a sample is the nearest point of the truth.
struct UnseenArea {
  double no_view = 0;    // no view sees the place
  double few_views = 0;  // some views see the place, but fewer than CloudOptions::least_views
  // At least CloudOptions::least_views views see the place, but the sample is farther from the
  // place than CloudEvaluation::gross.
  double far = 0;
  double total() const { return no_view + few_views + far; }
};

struct MeshEvaluation {
  NormalErrors normals;              // of all samples of the mesh
  std::optional<SeenPart> seen;      // nothing if there are no views
  std::optional<UnseenArea> unseen;  // nothing if there are no views
  Topology topology;
};

// Samples of a mesh, uniform by area, and for each sample the index of the face on which it lies.
struct MeshSamples {
  std::span<const Eigen::Vector3f> positions;
  std::span<const std::uint32_t> faces;
};

// Evaluates `mesh` by the samples that evaluate_mesh() has drawn. Preconditions: `samples` are the
// outputs `sampled` and `faces` of evaluate_mesh(), `whole` is its result, `truth` is its argument
// `surface`, and `mesh`, `views` and `options` are its arguments of these names. count_views() with
// `truth` decides which views see a place, so the mesh itself hides no place. Error as for
// topology_of() (topology.h).
MeshEvaluation evaluate_mesh_parts(const Mesh& mesh, const MeshSamples& samples,
                                   const geometry::Surface& truth, std::span<const View> views,
                                   const CloudOptions& options, const CloudEvaluation& whole);

}  // namespace axial::evaluate
