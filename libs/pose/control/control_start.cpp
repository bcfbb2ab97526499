// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/control/control_start.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "pose/bundle/known.h"
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

// The least-squares similarity in the plane of x and y: a turn about the vertical, a shift and, if
// `with_scale`, a scale. With x + iy as complex numbers p (present) and k (known), both less their
// means, the turn and scale are the complex number sum(conj(p) k) / sum(|p|^2).
Similarity in_plan(const Places& plan, bool with_scale) {
  Similarity result;
  if (plan.present.cols() == 0) return result;
  const Eigen::Vector2d present_middle = plan.present.topRows<2>().rowwise().mean();
  const Eigen::Vector2d known_middle = plan.known.topRows<2>().rowwise().mean();
  const Eigen::Matrix2Xd p = plan.present.topRows<2>().colwise() - present_middle;
  const Eigen::Matrix2Xd k = plan.known.topRows<2>().colwise() - known_middle;
  const Eigen::Vector2d turn(
      p.cwiseProduct(k).sum(),
      (p.row(0).cwiseProduct(k.row(1)) - p.row(1).cwiseProduct(k.row(0))).sum());
  if (turn.norm() > 0 && p.squaredNorm() > 0) {
    result.rotation = Eigen::AngleAxisd(std::atan2(turn.y(), turn.x()), Eigen::Vector3d::UnitZ())
                          .toRotationMatrix();
    if (with_scale) result.scale = turn.norm() / p.squaredNorm();
  }
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  middle.head<2>() = present_middle;
  result.translation.head<2>() = known_middle - result(middle).head<2>();
  return result;
}

// The wholly known places, if they determine a similarity; otherwise none.
Places places_of_similarity(const Bundle& bundle, const AdjustOptions& options) {
  const Places whole =
      places_of(bundle, options, [](const KnownPlace& place) { return place.knows_all(); });
  if (whole.known.cols() >= 3 && relative_width(whole.known) >= kLineWidth &&
      relative_width(whole.present) >= kLineWidth)
    return whole;
  return {};
}

}  // namespace

void place_by_control(Bundle& bundle, const AdjustOptions& options) {
  if (options.places.empty()) return;
  if (const Places whole = places_of_similarity(bundle, options); whole.known.cols() > 0)
    return move_places(bundle, robust_similarity(whole.present, whole.known).similarity);
  const auto heights = [&] {
    return places_of(bundle, options, [](const KnownPlace& place) { return place.knows(2); });
  };
  Similarity upright;
  upright.rotation = Eigen::Quaterniond::FromTwoVectors(upward(heights(), against_view(bundle)),
                                                        Eigen::Vector3d::UnitZ())
                         .toRotationMatrix();
  move_places(bundle, upright);
  move_places(bundle, in_plan(places_of(bundle, options, knows_plan), options.distances.empty()));
  if (const Places high = heights(); high.known.cols() > 0) {
    Similarity shift;
    shift.translation.z() = (high.known - high.present).row(2).mean();
    move_places(bundle, shift);
  }
}

std::vector<std::string> signs_of_a_mirror(const Bundle& bundle, const AdjustOptions& options) {
  const Places whole = places_of_similarity(bundle, options);
  if (whole.known.cols() == 0) return {};
  if (const MirroredFit fit = mirrored_fit(whole.present, whole.known); fit.better)
    return {"Control points: " + mirrored_line(fit)};
  if (against_view(bundle).z() > 0) return {};
  return {fmt::format(
      "Control points turn the model over: the cameras look upwards. If they looked down, {}",
      kCausesOfMirror)};
}

}  // namespace axial::pose
