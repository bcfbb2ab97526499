// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/bundle/observation_cost.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace axial::pose {
namespace {

Eigen::Matrix3d rotation_of(const Eigen::Vector3d& w) {
  const double angle = w.norm();
  if (angle == 0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, w / angle).toRotationMatrix();
}

void set_zero(double** jacobians) {
  if (!jacobians) return;
  constexpr std::array<int, 3> kSizes{kPoseNumbers, 3, kHousingNumbers};
  for (std::size_t block = 0; block < kSizes.size(); ++block)
    if (jacobians[block]) std::fill_n(jacobians[block], 2 * kSizes[block], 0.0);
}

template <int Columns>
using RowMajor = Eigen::Map<Eigen::Matrix<double, 2, Columns, Eigen::RowMajor>>;

}  // namespace

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

PoseNumbers numbers_of(const Pose& start) {
  return {0, 0, 0, start.centre.x(), start.centre.y(), start.centre.z()};
}

Pose pose_with(const Pose& start, const PoseNumbers& numbers) {
  return {rotation_of(Eigen::Map<const Eigen::Vector3d>(numbers.data())) * start.rotation,
          Eigen::Map<const Eigen::Vector3d>(numbers.data() + 3)};
}

Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& w) {
  const double angle2 = w.squaredNorm();
  const Eigen::Matrix3d W = cross_matrix(w);
  if (angle2 < 1e-8) return Eigen::Matrix3d::Identity() + 0.5 * W + W * W / 6;
  const double angle = std::sqrt(angle2);
  return Eigen::Matrix3d::Identity() + (1 - std::cos(angle)) / angle2 * W +
         (angle - std::sin(angle)) / (angle2 * angle) * W * W;
}

CurrentCameras::CurrentCameras(std::span<const BundleCamera> cameras, const double* changes)
    : measured_(cameras), changes_(changes) {
  for (std::size_t i = 0; i < measured_.size(); ++i) cameras_.push_back(now(i));
}

PresentCamera CurrentCameras::now(std::size_t camera) const {
  const HousingChange<double> change = Eigen::Map<const HousingChange<double>>(
      changes_ + kHousingNumbers * measured_[camera].same_as.value_or(camera));
  return {measured_[camera], change};
}

void CurrentCameras::PrepareForEvaluation(bool, bool new_evaluation_point) {
  if (!new_evaluation_point) return;
  for (std::size_t i = 0; i < cameras_.size(); ++i) cameras_[i] = now(i);
}

bool ObservationCost::Evaluate(double const* const* parameters, double* residuals,
                               double** jacobians) const {
  PoseNumbers numbers;
  std::copy_n(parameters[0], numbers.size(), numbers.begin());
  const Pose pose = pose_with(start_, numbers);
  const Eigen::Vector3d X = pose.to_camera(Eigen::Map<const Eigen::Vector3d>(parameters[1]));
  const PhotographImage image = now_.photograph.image(X);
  Eigen::Map<Eigen::Vector2d> residual(residuals);
  if (!image.visible) {
    // At least as far as any visible image lies from its observation.
    residual = Eigen::Vector2d(measured_.measured.lens.width, measured_.measured.lens.height);
    set_zero(jacobians);
    return true;
  }
  residual = image.pixel - observation_.pixel;
  if (!jacobians) return true;
  const refractive::Matrix23<double> by_point = image.by_tangents * image.tangents_by_point;
  if (jacobians[0]) {
    RowMajor<kPoseNumbers> by_pose(jacobians[0]);
    by_pose.leftCols<3>() = -by_point * cross_matrix(X) *
                            left_jacobian(Eigen::Map<const Eigen::Vector3d>(parameters[0]));
    by_pose.rightCols<3>() = -by_point * pose.rotation;
  }
  if (jacobians[1]) RowMajor<3>{jacobians[1]} = by_point * pose.rotation;
  if (jacobians[2]) {
    RowMajor<kHousingNumbers> by_change(jacobians[2]);
    by_change.leftCols<kPortNumbers>() =
        -by_point * now_.rays.at(image.tangents, (X - image.origin).norm());
    // The focal lengths scale the picture about the principal point.
    by_change.col(kFocalNumber) = image.pixel - now_.photograph.principal_point();
  }
  return true;
}

}  // namespace axial::pose
