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

// Returns the least-squares similarity (best_similarity) that maps source[i] to target[i]. The
// scale is 1 unless `with_scale`. Error if `source` and `target` have different lengths or fewer
// than three points, if a coordinate is not finite, or if `source` or `target` lies on one line,
// because the rotation about this line would be unknown. Points lie on one line if their
// relative_width() is at most kLineWidth (scene/decompositions.h).
Similarity fit_similarity(std::span<const Eigen::Vector3d> source,
                          std::span<const Eigen::Vector3d> target, bool with_scale = true);

struct CentreAlignment {
  Similarity similarity;
  std::vector<std::string> names;  // images that are in both models
  // `residuals` and `turns` are in the order of `names`.
  std::vector<double> residuals;  // distances of aligned and reference centres [reference unit]
  std::vector<double> turns;      // angles between aligned and reference rotations [rad]
  double rms = 0;                 // of `residuals`
};

// Returns the similarity that maps the camera centres of `model` to the camera centres of
// `reference`. Images are matched by name. Images without a partner are ignored. Errors as for
// fit_similarity, for the matched images.
CentreAlignment align_centres(const io::ColmapModel& model, const io::ColmapModel& reference);

// Reports the images of `reference` that have no partner in the model. Returns one line with the
// number of these images and the name of the first one. Returns nothing if all images have a
// partner. `alignment`: the result of align_centres for this reference.
std::vector<std::string> not_matched(const CentreAlignment& alignment,
                                     const io::ColmapModel& reference);

// Converts a similarity between local frames to a similarity between world coordinates.
// `similarity` maps coordinates in the frame `from` to coordinates in the frame `to`.
Similarity between_worlds(const Similarity& similarity, const LocalFrame& from,
                          const LocalFrame& to);

// Apply the similarity to the poses, points and normals of the argument. The images of the points
// do not change.
void apply(const Similarity& similarity, io::ColmapModel& model);
void apply(const Similarity& similarity, PointCloud& cloud);
void apply(const Similarity& similarity, Mesh& mesh);

// The matrix as text: four lines of four numbers, with all digits.
std::string matrix_text(const Similarity& similarity);

}  // namespace axial::evaluate
