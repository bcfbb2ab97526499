// SPDX-License-Identifier: GPL-3.0-or-later
// Similarity transformations between an estimated model and the true one.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "io/colmap/colmap.h"
#include "scene/decompositions.h"
#include "scene/local_frame.h"
#include "scene/mesh.h"
#include "scene/point_cloud.h"

namespace axial::evaluate {

using axial::Similarity;

// Returns best_similarity() from `source` to `target`, with scale 1 unless `with_scale`. Error for
// fewer than three pairs, coordinates that are not finite, or points on one line (their spread
// across it is below a thousandth of the spread along it), which do not fix the rotation.
Similarity fit_similarity(std::span<const Eigen::Vector3d> source,
                          std::span<const Eigen::Vector3d> target, bool with_scale = true);

struct CentreAlignment {
  Similarity similarity;
  std::vector<std::string> names;  // images that are in both models
  std::vector<double> residuals;   // of centres [unit of the reference], ordered as `names`
  std::vector<double> turns;       // angles between the rotations [rad], ordered as `names`
  double rms = 0;                  // of `residuals`
};

// Returns the similarity that takes the camera centres of `model` to those of `reference`. Images
// are matched by name. Errors as for fit_similarity.
CentreAlignment align_centres(const io::ColmapModel& model, const io::ColmapModel& reference);

// Reports the images of `reference` for which `model` has no image of the same name: one line with
// their number and the first name, or nothing if there are none. `alignment` is the result of
// align_centres.
std::vector<std::string> not_matched(const CentreAlignment& alignment,
                                     const io::ColmapModel& reference);

// Converts a similarity between local frames to world coordinates. `similarity` takes coordinates
// in `from` to coordinates in `to`.
Similarity between_worlds(const Similarity& similarity, const LocalFrame& from,
                          const LocalFrame& to);

// Apply the similarity to poses, points and normals. Reprojections do not change.
void apply(const Similarity& similarity, io::ColmapModel& model);
void apply(const Similarity& similarity, PointCloud& cloud);
void apply(const Similarity& similarity, Mesh& mesh);

// The matrix as text: four lines of four numbers, with all digits.
std::string matrix_text(const Similarity& similarity);

}  // namespace axial::evaluate
