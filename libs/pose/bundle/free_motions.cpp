// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/bundle/free_motions.h"

#include <algorithm>
#include <cmath>

#include "pose/bundle/known.h"
#include "scene/decompositions.h"

namespace axial::pose {
namespace {

constexpr double kNoChange = 1e-3;  // of the largest change

// A known coordinate: its axis, and the place of its point.
struct Coordinate {
  Eigen::Vector3d place;
  int axis;
};

std::vector<Coordinate> known_coordinates(const Bundle& bundle, const AdjustOptions& options) {
  std::vector<Coordinate> known;
  for (const KnownPlace& place : options.places)
    for (int k = 0; k < 3; ++k)
      if (place.knows(k)) known.push_back({place_in(bundle, place.of, place.index), k});
  for (const KnownPosition& position : options.positions)
    for (int k = 0; k < 3; ++k) known.push_back({bundle.images[position.image].pose.centre, k});
  return known;
}

}  // namespace

std::vector<Motion> free_motions(const Bundle& bundle, const AdjustOptions& options) {
  const std::vector<Coordinate> known = known_coordinates(bundle, options);
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Coordinate& one : known) middle += one.place / static_cast<double>(known.size());
  double extent = 0;
  for (const Coordinate& one : known) extent = std::max(extent, (one.place - middle).norm());
  // Rotations count as the shift at the farthest point.
  const double length = extent > 0 ? extent : 1;
  Eigen::Matrix<double, Eigen::Dynamic, 6> changes(static_cast<Eigen::Index>(known.size()), 6);
  for (std::size_t i = 0; i < known.size(); ++i) {
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(known[i].axis);
    changes.row(static_cast<Eigen::Index>(i))
        << (known[i].place - middle).cross(axis).transpose() / length,
        axis.transpose();
  }
  const EigenPairs pairs = symmetric_eigen(changes.transpose() * changes);
  std::vector<Motion> motions;
  for (Eigen::Index k = 0; k < 6; ++k) {
    if (pairs.values(k) > kNoChange * kNoChange * pairs.values(5)) continue;
    const Eigen::VectorXd motion = pairs.vectors.col(k);
    motions.push_back({motion.head(3) / length, middle, motion.tail(3)});
  }
  return motions;
}

}  // namespace axial::pose
