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
#include "scene/robust_similarity.h"

namespace axial::evaluate {

using axial::Similarity;

// Returns the similarity that maps source[i] to target[i], without the outliers
// (robust_similarity() in scene/robust_similarity.h), for any unit and frame of both. The scale is
// 1 unless `with_scale`. Error if `source` and `target` have different lengths or fewer than three
// points, if a coordinate is not finite, or if `source` or `target` lies on one line, because the
// rotation about this line would be unknown. Points lie on one line if their relative_width() is at
// most kLineWidth (scene/decompositions.h). Error that names the usual causes if the mirror image
// of `source` fits much better (MirroredFit::better). Error that names the position that alone is
// off a line and does not fit (RobustSimilarity::off_line). `names`: of all positions, for this
// error; empty: numbers from 1.
RobustSimilarity fit_positions(std::span<const Eigen::Vector3d> source,
                               std::span<const Eigen::Vector3d> target, bool with_scale = true,
                               std::span<const std::string> names = {});

// The similarity of fit_positions().
Similarity fit_similarity(std::span<const Eigen::Vector3d> source,
                          std::span<const Eigen::Vector3d> target, bool with_scale = true);

// The result of align_centres(). Aligned means moved by `similarity`.
struct CentreAlignment {
  Similarity similarity;           // from the model's world to the reference's world
  std::vector<std::string> names;  // images that are in both models, in the order of the model
  // `residuals` and `turns` are in the order of `names`.
  std::vector<double> residuals;  // distances of aligned and reference centres [reference unit]
  std::vector<double> turns;      // angles between aligned and reference rotations [rad]
  double rms = 0;                 // root mean square of `residuals` [reference unit]
  // The same, the largest residual and the largest turn without the centres that do not fit the
  // others, and a line of text for each of these (outlier_lines() in scene/robust_similarity.h).
  double rms_of_fitting = 0, largest = 0, largest_turn = 0;
  std::vector<std::string> outliers;
};

// Returns the similarity that maps the camera centres of `model` to the camera centres of
// `reference` (fit_positions()). Images are matched by name. Images without a partner are ignored.
// Error if fewer than three images match, if a matched centre is not finite, or if the matched
// centres of one model lie on one line (see fit_similarity()).
CentreAlignment align_centres(const io::ColmapModel& model, const io::ColmapModel& reference);

// Reports the images of `reference` that have no partner in the model. Returns one line of text
// with the number of these images and the name of the first one in the order of `reference`.
// Returns no line if all images have a partner. `alignment`: the result of align_centres() for this
// reference.
std::vector<std::string> not_matched(const CentreAlignment& alignment,
                                     const io::ColmapModel& reference);

// Converts a similarity between local frames to a similarity between world coordinates.
// `similarity` maps coordinates in the frame `from` to coordinates in the frame `to`. The result
// maps coordinates in the world of `from` to coordinates in the world of `to`.
Similarity between_worlds(const Similarity& similarity, const LocalFrame& from,
                          const LocalFrame& to);

// Apply the similarity to the poses, points and normals that the argument has. Normals are only
// rotated. Each point keeps its pixel in each image, because poses and points move together.
void apply(const Similarity& similarity, io::ColmapModel& model);
void apply(const Similarity& similarity, PointCloud& cloud);
void apply(const Similarity& similarity, Mesh& mesh);

// The homogeneous matrix of the similarity (Similarity::matrix()) as text: one line for each of the
// four rows, with four numbers separated by spaces. The numbers have up to 17 significant digits,
// so that reading them gives the identical doubles.
std::string matrix_text(const Similarity& similarity);

}  // namespace axial::evaluate
