// SPDX-License-Identifier: GPL-3.0-or-later
// Finds and removes the surface that a mesh has where the cameras saw none. The cut (cut.h) closes
// the surface behind everything that hides something; cleaning closes holes.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/context.h"
#include "geometry/face_sights.h"
#include "scene/mesh.h"
#include "scene/scene.h"

namespace axial::mesh {

struct UnseenOptions {
  bool keep = false;  // treat_unseen(): true: unseen faces are marked instead of removed
  // unseen_faces(): whether the size of a face, and its distance to `points`, tell if the face was
  // measured. False for decimated meshes.
  bool sizes_tell = true;
  // unseen_faces(): the points of which the mesh was made, in its frame, or every k-th of them, at
  // most enough_points() (point_distances.h). Empty: not known. They must outlive the call.
  std::span<const Eigen::Vector3f> points = {};
  double small_holes = 5;  // of unseen_faces()
  double cut_off = 20;     // of without_unseen()
};

// Returns Mesh::unseen of `mesh`: 1 for the faces whose place no two cameras have seen, 0 for the
// others. There are two kinds of unseen faces:
//   1. No two cameras see the middle of the face from the front (geometry::second_cosines).
//   2. Two cameras see it, but only at a grazing angle, and a chain of faces of this kind, each
//      with a common edge with the next, connects it to a face of the first kind. Grazing: the
//      second largest cosine of the angle between the face's normal and the ray of a camera is
//      below 0.2 (r - 3), at most 0.4. r is the longest edge of the face divided by the median
//      longest edge of all faces.
// If `points` are known, they decide instead of the sizes, unless they are too sparse: if the
// median distance below is more than the median longest edge, the points are not those of the mesh,
// or too few of them, and the sizes decide. A face is far from them if the distance
// from its middle to the nearest point is more than nine times the median of this distance over all
// faces. Only faces that are far from the points are unseen:
//   1. those with a cosine of at most 0.25, or that no two cameras see,
//   2. those with a cosine below 0.5 that are connected to the first ones.
// If `sizes_tell` is false, all faces that no two cameras see are unseen, and there is no second
// kind.
//
// The reason for the distance: every point was measured by two cameras or more. A face near points
// whose middle seems to be hidden is hidden by the noise of the mesh. The reason for the second
// kind: the surface that closes an unseen place often begins along the last rays that pass the
// place, so that cameras do see its front, but at grazing angles. It has large faces, because there
// are no points inside. Other large faces are true surface with little texture.
//
// Exception: unseen faces inside the seen surface count as seen if they form a set whose bounding
// box has a diagonal of at most `small_holes` median longest edges. `context` gets the numbers of
// cameras. The result does not depend on the number of threads.
//
// Precondition: the mesh is manifold and oriented. Throws an Error for a mesh that
// geometry::Surface refuses.
std::vector<std::uint8_t> unseen_faces(const Mesh& mesh,
                                       std::span<const geometry::PosedCamera> cameras,
                                       const UnseenOptions& options = {},
                                       const Context& context = {});

// What without_unseen() removed.
struct UnseenReport {
  std::size_t faces = 0;   // all removed faces
  std::size_t pieces = 0;  // number of pieces that were cut off and were too small
};

// Returns the mesh without the faces that `unseen` marks. In addition, these faces are removed:
//   - faces that would hang on the mesh by one edge,
//   - where the rest of the surface would touch itself at a vertex alone, all of its parts there
//     but the largest,
//   - pieces that are cut off and whose bounding box has a diagonal below `cut_off` mean edge
//     lengths; the largest piece of each component stays.
// The result is manifold and oriented like `mesh`. Its vertices have the same positions and order.
// Precondition: `unseen` has one entry for each face.
Mesh without_unseen(const Mesh& mesh, std::vector<std::uint8_t> unseen, double cut_off,
                    UnseenReport* report = nullptr);

// Returns `mesh` without its unseen faces (without_unseen()), or, if UnseenOptions::keep is true,
// with marks of its unseen faces (Mesh::unseen). `context` gets the numbers and the shares of area.
// With fewer than two cameras, nothing is removed or marked, and it warns. Throws an Error if
// removal would leave no face. Precondition and other Errors as for unseen_faces().
Mesh treat_unseen(Mesh mesh, std::span<const geometry::PosedCamera> cameras,
                  const UnseenOptions& options, const Context& context = {});

// The memory [bytes] of treat_unseen() with its result and with UnseenOptions::points, besides
// `mesh`.
std::uint64_t bytes_of_unseen(const Mesh& mesh);

}  // namespace axial::mesh
