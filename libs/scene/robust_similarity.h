// SPDX-License-Identifier: GPL-3.0-or-later
// Similarities to known positions of which some may be wrong.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/decompositions.h"

namespace axial {

// A similarity, and the points that it does not map to their partners.
struct RobustSimilarity {
  Similarity similarity;
  std::vector<std::size_t> outliers;  // columns that do not fit the others, in ascending order
  std::vector<double> distances;      // of each moved point from its partner [unit of `to`]
  double rms = 0;                     // root mean square of the distances without the outliers
  // The column that does not fit, although the other points are on a line. Without this point no
  // similarity is determined, so the point is no outlier, but counts in the fit, which is useless.
  std::optional<std::size_t> off_line = {};
};

// The least-squares similarity (best_similarity) of the points without the outliers. Points and
// preconditions as for best_similarity(). Without outliers it is best_similarity() of all points,
// to the last bit.
//
// Outliers are found by the least median of squares (P. J. Rousseeuw, 1984): similarities through
// three points, all triples of up to 24 points, otherwise 500 random ones, always the same. The one
// with the smallest distance that more than half of the points keep is improved by least squares of
// the nearest points (P. J. Rousseeuw and K. Van Driessen, 2006). A point is an outlier if its
// distance is more than 10 standard deviations of the other distances (15 if fewer than eight
// points fit, 30 if four do, 200 if three do, because their distances say little about the noise),
// more than 1e-4 of the extent of the points, and if the other points are not on a line. The
// standard deviation counts the uncertainty of the fit at the place of the point. So neither
// ordinary nor coarse noise makes an outlier, and at least four points are needed to find one.
RobustSimilarity robust_similarity(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to,
                                   bool with_scale = true);

// How well the mirror image of points fits, compared with the points themselves.
struct MirroredFit {
  double rms = 0, mirrored_rms = 0;  // without the outliers of the mirrored fit [unit of `to`]
  // True: the mirror image fits at least 5 times better (20 times with fewer than six points),
  // which noise does not explain.
  bool better = false;
  // True: both fit about equally well, as for points on a plane.
  bool alike = false;
};

// Fits `from` and its mirror image to `to`. Arguments as for robust_similarity().
MirroredFit mirrored_fit(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to,
                         bool with_scale = true);

// The sentence of the error for RobustSimilarity::off_line. `name`: of this point. Precondition:
// off_line is set.
std::string off_line_sentence(const RobustSimilarity& fit, const std::string& name);

// The two usual causes of positions that fit the mirror image of the cameras, as the end of an
// error or a warning.
inline constexpr const char* kCausesOfMirror =
    "either their third coordinate is a depth, positive downwards (give the height), or the "
    "northing "
    "stands before the easting (exchange the two)";

// The sentence of the error for MirroredFit::better.
std::string mirrored_line(const MirroredFit& fit);

// One line for each outlier, of which at most five are told one by one: the position of names[k]
// and its distance in metres. `names`: of all points.
std::vector<std::string> outlier_lines(const RobustSimilarity& fit,
                                       std::span<const std::string> names);

}  // namespace axial
