// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosis/free_directions.h"

#include <Eigen/Cholesky>
#include <limits>

namespace axial::diagnosis {
namespace {

constexpr double kFreeDamping = 1e-9;  // keeps undetermined changes small
constexpr double kScaleWeight = 1e6;   // weight of the distance that is kept
constexpr Eigen::Index kPose = 6;

Eigen::Index row_of(std::size_t observation) {
  return 2 * static_cast<Eigen::Index>(observation);
}

Eigen::Index pose_of(const pose::Observation& observation) {
  return kPose * static_cast<Eigen::Index>(observation.image);
}

// The normal equations after the elimination of the points (Schur's complement).
struct Reduced {
  Eigen::MatrixXd left, right;
};

// The part of the equations that belongs to one point.
struct PointPart {
  Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero();
  Eigen::Matrix3Xd right;
};

using Tracks = std::vector<std::vector<std::size_t>>;  // observations of each point

PointPart point_part(const LinearizedTracks& tracks, std::span<const std::size_t> track,
                     const Eigen::MatrixXd& columns) {
  PointPart part;
  part.right = Eigen::Matrix3Xd::Zero(3, columns.cols());
  Eigen::Matrix3d V = Eigen::Matrix3d::Zero();
  for (const std::size_t i : track) {
    const auto& by = tracks.terms[i].by_point;
    V += by.transpose() * by;
    part.right += by.transpose() * columns.middleRows<2>(row_of(i));
  }
  V.diagonal().array() += kFreeDamping * V.trace() + std::numeric_limits<double>::min();
  part.inverse = V.ldlt().solve(Eigen::Matrix3d::Identity());
  return part;
}

void eliminate(const LinearizedTracks& tracks, std::span<const std::size_t> track,
               const PointPart& part, Reduced& reduced) {
  for (const std::size_t i : track) {
    const Eigen::Matrix<double, 6, 3> W =
        tracks.terms[i].by_pose.transpose() * tracks.terms[i].by_point * part.inverse;
    const Eigen::Index row = pose_of(tracks.observations[i]);
    reduced.right.middleRows<kPose>(row) -= W * part.right;
    for (const std::size_t k : track)
      reduced.left.block<kPose, kPose>(row, pose_of(tracks.observations[k])) -=
          W * tracks.terms[k].by_point.transpose() * tracks.terms[k].by_pose;
  }
}

void hold_scale(std::span<const Eigen::Vector3d> centres, Eigen::MatrixXd& left) {
  std::size_t far = 0;
  const auto from_first = [&](std::size_t i) { return Eigen::Vector3d(centres[i] - centres[0]); };
  for (std::size_t i = 1; i < centres.size(); ++i)
    if (from_first(i).norm() > from_first(far).norm()) far = i;
  if (far == 0) return;
  Eigen::VectorXd change = Eigen::VectorXd::Zero(left.rows());
  const Eigen::Vector3d along = from_first(far).normalized();
  change.segment<3>(3) = -along;
  change.segment<3>(kPose * static_cast<Eigen::Index>(far) + 3) = along;
  left += kScaleWeight * left.diagonal().maxCoeff() * change * change.transpose();
}

Reduced reduce(const LinearizedTracks& tracks, const Tracks& of_point,
               std::span<const PointPart> parts, const Eigen::MatrixXd& columns) {
  const Eigen::Index size = kPose * static_cast<Eigen::Index>(tracks.centres.size());
  Reduced reduced{Eigen::MatrixXd::Zero(size, size), Eigen::MatrixXd::Zero(size, columns.cols())};
  for (std::size_t i = 0; i < tracks.terms.size(); ++i) {
    const auto& by = tracks.terms[i].by_pose;
    const Eigen::Index row = pose_of(tracks.observations[i]);
    reduced.left.block<kPose, kPose>(row, row) += by.transpose() * by;
    reduced.right.middleRows<kPose>(row) += by.transpose() * columns.middleRows<2>(row_of(i));
  }
  const Eigen::VectorXd damping =
      kFreeDamping * reduced.left.diagonal().array() + std::numeric_limits<double>::min();
  for (std::size_t p = 0; p < of_point.size(); ++p)
    eliminate(tracks, of_point[p], parts[p], reduced);
  reduced.left.diagonal() += damping;
  hold_scale(tracks.centres, reduced.left);
  return reduced;
}

}  // namespace

void remove_poses_and_points(const LinearizedTracks& tracks, Eigen::MatrixXd& columns) {
  const Tracks of_point =
      observations_of_each(tracks.observations, &pose::Observation::point, tracks.points);
  std::vector<PointPart> parts;
  for (const auto& track : of_point) parts.push_back(point_part(tracks, track, columns));
  const Reduced reduced = reduce(tracks, of_point, parts, columns);
  const Eigen::MatrixXd poses = reduced.left.ldlt().solve(reduced.right);
  for (std::size_t p = 0; p < of_point.size(); ++p) {
    Eigen::Matrix3Xd right = parts[p].right;
    for (const std::size_t i : of_point[p])
      right -= tracks.terms[i].by_point.transpose() * tracks.terms[i].by_pose *
               poses.middleRows<kPose>(pose_of(tracks.observations[i]));
    const Eigen::Matrix3Xd point = parts[p].inverse * right;
    for (const std::size_t i : of_point[p])
      columns.middleRows<2>(row_of(i)) -=
          tracks.terms[i].by_pose * poses.middleRows<kPose>(pose_of(tracks.observations[i])) +
          tracks.terms[i].by_point * point;
  }
}

}  // namespace axial::diagnosis
