// SPDX-License-Identifier: GPL-3.0-or-later
// How many cameras look at each face of a mesh, and at which side of it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "base/progress.h"
#include "geometry/posed_camera.h"
#include "geometry/surface.h"
#include "scene/mesh.h"

namespace axial::geometry {

struct SightOptions {
  // A face does not hide a point if it crosses the path of light less than tolerance * L from the
  // point. L is the length of the path from the point to the place where the light leaves the
  // water. Range: 0 to 1.
  double tolerance = 1e-3;
  // The smallest |cosine| of the angle between the path of light and the normal of a face at which
  // a camera counts. Range: 0 to 1.
  double least_cosine = 0;
};

// For each face, the numbers of cameras that see its middle from either side. The front is the side
// from which the corners of the face are counterclockwise.
struct FaceSights {
  std::vector<std::uint16_t> front, back;
};

// Counts the cameras that see the middle of each face (the mean of its corners). A camera sees a
// point if the exact projection of the point lies in the image rectangle, from -0.5 to
// width - 0.5 and from -0.5 to height - 0.5, and if no face of the mesh crosses the path of light
// from the point to the place where the light leaves the water. Numbers above 65,535 count as
// 65,535. Faces without area are seen from no side. Calls progress(done, total) with numbers of
// cameras. The result does not depend on the number of threads. Error for a mesh that Surface
// refuses (geometry/surface.h).
FaceSights count_sights(const Mesh& mesh, std::span<const PosedCamera> cameras,
                        const SightOptions& options = {}, const ProgressSink& progress = {});

// The same for some faces: entry i of the result belongs to the face faces[i]. `surface`: of
// `mesh`.
FaceSights count_sights(const Mesh& mesh, const Surface& surface,
                        std::span<const std::uint32_t> faces, std::span<const PosedCamera> cameras,
                        const SightOptions& options = {});

// Returns for each face how well the second best of the cameras sees it: the second largest cosine
// of the angle between the path of light from the middle of the face and the smoothed normal of the
// face, over the cameras that see the middle in the sense of count_sights(). The smoothed normal is
// the mean of the normals at the corners, so that the noise of single faces does not matter. -1 if
// fewer than two cameras see the middle. `enough`: larger cosines may be returned as any number
// from `enough` on; faces that have it are not tested again, which saves most of the time in scenes
// of many cameras. SightOptions::least_cosine has no effect. Progress, threads and Errors as for
// count_sights().
std::vector<float> second_cosines(const Mesh& mesh, std::span<const PosedCamera> cameras,
                                  float enough, const SightOptions& options = {},
                                  const ProgressSink& progress = {});

// The memory [bytes] of count_sights() with its result, and of second_cosines() with its result.
std::uint64_t bytes_of_sights(const Mesh& mesh);
std::uint64_t bytes_of_cosines(const Mesh& mesh);

}  // namespace axial::geometry
