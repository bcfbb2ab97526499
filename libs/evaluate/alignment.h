// SPDX-License-Identifier: GPL-3.0-or-later
// Similarities between an estimated model and the truth.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "io/colmap.h"
#include "scene/local_frame.h"
#include "scene/mesh.h"
#include "scene/point_cloud.h"

namespace axial::evaluate {

// x -> scale * rotation * x + translation.
struct Similarity {
  double scale = 1;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  Eigen::Vector3d operator()(const Eigen::Vector3d& x) const {
    return scale * (rotation * x) + translation;
  }
  // First `first`, then this one.
  Similarity after(const Similarity& first) const;
  Eigen::Matrix4d matrix() const;
};

// The least-squares similarity from `source` to `target` (Umeyama 1991), never a reflection. Error
// for fewer than three pairs, coordinates that are not finite, or points that lie on one line
// (their spread across it below a thousandth of that along it), which leave a rotation open.
Similarity fit_similarity(std::span<const Eigen::Vector3d> source,
                          std::span<const Eigen::Vector3d> target);

struct CentreAlignment {
  Similarity similarity;
  std::vector<std::string> names;  // of the images in both models
  std::vector<double> residuals;   // of centres [unit of the reference], as `names`
  std::vector<double> turns;       // of images against the reference's [rad], as `names`
  double rms = 0;                  // of `residuals`
};

// The similarity that takes the camera centres of `model` to those of `reference`, images matched
// by name. Error as fit_similarity.
CentreAlignment align_centres(const io::ColmapModel& model, const io::ColmapModel& reference);

// One line where `reference` has images that `alignment`, of align_centres, found none of the same
// name for: their number and the first. Empty where all have one.
std::vector<std::string> not_matched(const CentreAlignment& alignment,
                                     const io::ColmapModel& reference);

// The similarity of world to world that `similarity` is from coordinates in `from` to those in
// `to`.
Similarity between_worlds(const Similarity& similarity, const LocalFrame& from,
                          const LocalFrame& to);

// Poses, points and normals under the similarity. Reprojections do not change.
void apply(const Similarity& similarity, io::ColmapModel& model);
void apply(const Similarity& similarity, PointCloud& cloud);
void apply(const Similarity& similarity, Mesh& mesh);

// Four lines of four numbers, row by row, with all digits.
std::string matrix_text(const Similarity& similarity);

}  // namespace axial::evaluate
