// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/pose: the residuals of rigs in bundle adjustment. A pose of a camera in its rig
// is a parameter block with the numbers of PoseNumbers (observation_cost.h), whose start is
// RigCamera::now.
#pragma once

#include <ceres/rotation.h>

#include "pose/bundle/bundle.h"
#include "pose/bundle/observation_cost.h"

namespace axial::pose {

// The rotation and the centre of a pose whose numbers the solver changes.
template <class T>
struct PoseOf {
  PoseOf(const Pose& start, const T* numbers) {
    Eigen::Matrix<T, 3, 3> turn;
    ceres::AngleAxisToRotationMatrix(numbers, turn.data());
    rotation = turn * start.rotation.cast<T>();
    centre = Eigen::Map<const Eigen::Matrix<T, 3, 1>>(numbers + 3);
  }
  Eigen::Matrix<T, 3, 3> rotation;
  Eigen::Matrix<T, 3, 1> centre;
};

// Writes the rotation vector of `rotation` [rad], divided by `sigma`.
template <class T>
void write_rotation(const Eigen::Matrix<T, 3, 3>& rotation, double sigma, T* residual) {
  ceres::RotationMatrixToAngleAxis(rotation.data(), residual);
  for (int k = 0; k < 3; ++k) residual[k] /= sigma;
}

// The deviation of the second of two photographs of one frame from the pose that follows from the
// first and from the poses of both cameras in their rig, in standard deviations: 3 numbers of the
// translation in the frame of the rig, and 3 of the rotation. Parameter blocks: the poses of both
// photographs, then of both cameras in the rig. The starts must outlive the object.
struct RigResidual {
  const Pose &first, &second, &first_in_rig, &second_in_rig;
  // How far the rig moves between the two exposures, in the frame of the rig [m].
  Eigen::Vector3d moved;

  template <class T>
  bool operator()(const T* a, const T* b, const T* a_in_rig, const T* b_in_rig, T* residual) const {
    const PoseOf<T> one(first, a), two(second, b);
    const PoseOf<T> one_in_rig(first_in_rig, a_in_rig), two_in_rig(second_in_rig, b_in_rig);
    const Eigen::Matrix<T, 3, 3> rig = one_in_rig.rotation.transpose() * one.rotation;
    Eigen::Map<Eigen::Matrix<T, 3, 1>> translation(residual);
    translation = (rig * (two.centre - one.centre) + one_in_rig.centre - two_in_rig.centre -
                   moved.cast<T>()) /
                  T(kFrameTranslation);
    const Eigen::Matrix<T, 3, 3> turn = two.rotation * (two_in_rig.rotation * rig).transpose();
    write_rotation(turn, kFrameRotation, residual + 3);
    return true;
  }
};

// The deviation of a camera in its rig from its stated pose, in standard deviations. Parameter
// block: the pose of the camera in the rig. The camera must outlive the object.
struct StatedRigResidual {
  const RigCamera& camera;

  template <class T>
  bool operator()(const T* numbers, T* residual) const {
    const PoseOf<T> now(camera.now, numbers);
    Eigen::Map<Eigen::Matrix<T, 3, 1>> translation(residual);
    translation = (now.centre - camera.stated.centre.cast<T>()) / T(camera.sigma_translation);
    const Eigen::Matrix<T, 3, 3> turn = now.rotation * camera.stated.rotation.transpose().cast<T>();
    write_rotation(turn, camera.sigma_rotation, residual + 3);
    return true;
  }
};

}  // namespace axial::pose
