// SPDX-License-Identifier: GPL-3.0-or-later
// The views that see each face of a mesh, with a measure of quality.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "axial/texture.h"
#include "base/progress.h"
#include "geometry/surface.h"
#include "scene/mesh.h"
#include "texture/faces/mesh_tiles.h"

namespace axial::texture {

struct ViewMemory {
  MemoryBudget budget;            // of find_face_views() with its result, besides the mesh
  std::uint64_t image_bytes = 0;  // of ImageSource while it makes an image, with the image
};

// Finds for each face the views that see all of the face (Sight::whole). The conditions are:
//   1. The face is turned towards the camera.
//   2. The corners are inside the image. Corners are projected by the exact camera.
//   3. All pixels in the face and up to 1.42 px around it are usable (ViewImage::usable).
//   4. No face hides the corners. If the face has 16 px^2 or more, no face hides the points of a
//      grid inside it. A point is hidden if a face crosses the path of light from the point to the
//      place where the light leaves the water (exit_point of the camera).
//
// Marked faces (Mesh::unseen) get no views, but they hide other faces.
//
// If no view sees all of a face, the face gets the views that see its middle. Such a view satisfies
// conditions 2 and 3, the middle of the face is not hidden, and the face or its smoothed normal is
// turned towards the camera.
//
// The smoothed normal of a face is the mean of the normals at its three corners. The quality is the
// area of the face in the image [px^2] times max(0.001, c)^2. Here c is the cosine of the angle
// between the smoothed normal and the path of light from the middle of the face.
//
// Calls progress(done, total) with numbers of views, from any thread but one call at a time. As
// many views are in work at the same time as there are threads, or fewer if `memory.budget` demands
// it. `images` is not asked for a view whose image contains no face. Throws an Error if
// geometry::Surface refuses the mesh, or if the budget does not suffice for one view or for the
// result. Exceptions of `images` are passed on.
FaceViews find_face_views(const Mesh& mesh, std::span<const View> views, const ImageSource& images,
                          const VisibilityOptions& options = {}, const ProgressSink& progress = {},
                          const ViewMemory& memory = {});

// What the sights of a face depend on, besides the face: the faces that can hide it, and the
// normals of the mesh's vertices.
struct Surroundings {
  // `mesh` must outlive the object. Errors as for geometry::Surface.
  explicit Surroundings(const Mesh& mesh);

  geometry::Surface surface;
  std::vector<Eigen::Vector3f> normals;
};

// The memory [bytes] of Surroundings while they are made.
std::uint64_t bytes_of_surroundings(const Mesh& mesh);

// As above, for the faces of a part of a mesh. `whole`: of the whole mesh. The result is what the
// function above returns for these faces of the whole mesh. `memory.budget`: besides `whole`.
FaceViews find_face_views(const MeshPart& part, const Surroundings& whole,
                          std::span<const View> views, const ImageSource& images,
                          const VisibilityOptions& options, const ProgressSink& progress,
                          const ViewMemory& memory);

}  // namespace axial::texture
