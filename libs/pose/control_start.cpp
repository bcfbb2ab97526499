// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/control_start.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "pose/known.h"
#include "scene/decompositions.h"
#include "scene/robust_similarity.h"

namespace axial::pose {
namespace {

// The present and the known places that `takes` accepts, as columns.
struct Places {
  Eigen::Matrix3Xd present, known;
};

template <class Takes>
Places places_of(const Bundle& bundle, const AdjustOptions& options, const Takes& takes) {
  Places places;
  for (const KnownPlace& known : options.places) {
    if (!takes(known)) continue;
    const Eigen::Index column = places.present.cols();
    places.present.conservativeResize(3, column + 1);
    places.known.conservativeResize(3, column + 1);
    places.present.col(column) = place_in(bundle, known.of, known.index);
    places.known.col(column) = known.metres;
  }
  return places;
}

bool knows_plan(const KnownPlace& place) {
  return place.knows(0) && place.knows(1);
}

void move(Bundle& bundle, const Similarity& similarity) {
  for (BundleImage& image : bundle.images) image.pose = similarity(image.pose);
  for (BundlePoint& point : bundle.points) point.position = similarity(point.position);
}

Eigen::Vector3d against_view(const Bundle& bundle) {
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  for (const BundleImage& image : bundle.images) up -= image.pose.rotation.row(2).transpose();
  return up.norm() > 0 ? up.normalized() : Eigen::Vector3d::UnitZ();
}

// The direction, in the present frame of the model, along which the places have their known
// heights. Places near a plane determine its part in this plane. `guess`: on which side of the
// plane the direction lies.
Eigen::Vector3d upward(const Places& heights, const Eigen::Vector3d& guess) {
  const Eigen::Matrix3Xd off = heights.present.colwise() - heights.present.rowwise().mean();
  if (off.cols() < 3 || relative_width(heights.present) < kLineWidth) return guess;
  const Eigen::VectorXd high = heights.known.row(2).array() - heights.known.row(2).mean();
  const SymmetricEigen3 axes(off * off.transpose());
  const Eigen::Vector3d normal = axes.eigenvectors().col(0);
  Eigen::Vector3d in_plane = Eigen::Vector3d::Zero();
  for (int k = 1; k < 3; ++k) {
    const Eigen::Vector3d axis = axes.eigenvectors().col(k);
    const Eigen::VectorXd along = off.transpose() * axis;
    in_plane += along.dot(high) / along.squaredNorm() * axis;
  }
  const double across = std::sqrt(std::max(0.0, 1 - in_plane.squaredNorm()));
  return (in_plane + std::copysign(across, normal.dot(guess)) * normal).normalized();
}

// Turns and shifts the model in the plane of x and y.
Similarity in_plan(Places plan, bool with_scale) {
  plan.present.row(2).setZero();
  plan.known.row(2).setZero();
  if (plan.present.cols() >= 2) return best_similarity(plan.present, plan.known, with_scale);
  Similarity shift;
  if (plan.present.cols() == 1) shift.translation = (plan.known - plan.present).col(0);
  return shift;
}

}  // namespace

bool determine_scale(const AdjustOptions& options) {
  return !options.distances.empty() || std::ranges::count_if(options.places, knows_plan) >= 2;
}

void place_by_control(Bundle& bundle, const AdjustOptions& options) {
  if (options.places.empty()) return;
  const Places whole =
      places_of(bundle, options, [](const KnownPlace& place) { return place.knows_all(); });
  if (whole.known.cols() >= 3 && relative_width(whole.known) >= kLineWidth &&
      relative_width(whole.present) >= kLineWidth)
    return move(bundle, robust_similarity(whole.present, whole.known).similarity);
  const auto heights = [&] {
    return places_of(bundle, options, [](const KnownPlace& place) { return place.knows(2); });
  };
  Similarity upright;
  upright.rotation = Eigen::Quaterniond::FromTwoVectors(upward(heights(), against_view(bundle)),
                                                        Eigen::Vector3d::UnitZ())
                         .toRotationMatrix();
  move(bundle, upright);
  move(bundle, in_plan(places_of(bundle, options, knows_plan), options.distances.empty()));
  if (const Places high = heights(); high.known.cols() > 0) {
    Similarity shift;
    shift.translation.z() = (high.known - high.present).row(2).mean();
    move(bundle, shift);
  }
}

}  // namespace axial::pose
