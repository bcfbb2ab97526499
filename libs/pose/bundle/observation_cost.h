// SPDX-License-Identifier: GPL-3.0-or-later
// The residual of refractive bundle adjustment: the reprojection error of one observation by the
// exact projection, with analytic derivatives.
#pragma once

#include <ceres/evaluation_callback.h>
#include <ceres/sized_cost_function.h>

#include <array>
#include <vector>

#include "pose/bundle/bundle.h"
#include "pose/bundle/rays_by_change.h"

namespace axial::pose {

// The parameter block of a pose. The numbers 0 to 2 are a rotation vector w [rad], and the
// numbers 3 to 5 are the camera centre C [m, world frame]. Let R be the rotation of the pose at
// which the adjustment starts. A world point X has the camera coordinates exp([w]x) R (X - C).
inline constexpr int kPoseNumbers = 6;
using PoseNumbers = std::array<double, kPoseNumbers>;

// `start`: the pose at which the adjustment starts. numbers_of() returns the numbers of `start`
// itself: w = 0 and C = start.centre. pose_with() returns the pose that has the numbers `numbers`.
PoseNumbers numbers_of(const Pose& start);
Pose pose_with(const Pose& start, const PoseNumbers& numbers);

// The matrix M of a cross product: M u = v x u for every vector u.
Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v);

// The left Jacobian J of the rotation group at the rotation vector w [rad]. For every vector v,
// d(exp([w]x) v)/dw = -[exp([w]x) v]x J.
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& w);

// A camera of a bundle with a change applied: its images, and how they depend on the change.
struct PresentCamera {
  // The member `change` of `camera` is ignored.
  PresentCamera(const BundleCamera& camera, const HousingChange<double>& change)
      : photograph(with_change(camera.measured, change)), rays(camera.measured.port, change) {}

  PhotographCamera photograph;
  RaysByChange rays;
};

// The cameras for the present values of the solver's parameter blocks. They are built once for each
// point at which the solver evaluates the cost, and not for each observation.
class CurrentCameras : public ceres::EvaluationCallback {
 public:
  // `changes`: the solver's parameter blocks, one per camera with kHousingNumbers numbers, in the
  // order of `cameras` and one after the other. The block of a camera with
  // BundleCamera::same_as is not used. Both arrays must outlive the object.
  CurrentCameras(std::span<const BundleCamera> cameras, const double* changes);

  // Called by the solver. Rebuilds the cameras from `changes` if `new_evaluation_point` is true.
  void PrepareForEvaluation(bool evaluate_jacobians, bool new_evaluation_point) override;

  // The camera with the index `camera`. The reference stays valid as long as the object.
  const PresentCamera& operator[](std::size_t camera) const { return cameras_[camera]; }

 private:
  PresentCamera now(std::size_t camera) const;

  std::span<const BundleCamera> measured_;
  const double* changes_;
  std::vector<PresentCamera> cameras_;
};

// The residual [px of the photograph] of one observation: the projected minus the observed pixel.
// Parameter blocks, in this order: the numbers of the pose (PoseNumbers), the point [m, world
// frame] and the change of the camera (HousingChange). A point that is not visible
// (PhotographImage::visible) has the residual (width, height) of the photograph with zero
// derivatives. The loss function bounds the weight of this residual.
class ObservationCost : public ceres::SizedCostFunction<2, kPoseNumbers, 3, kHousingNumbers> {
 public:
  // `start`: the pose of the observation's image at which the adjustment starts. `measured`: the
  // image's camera in the bundle. `now`: this camera in CurrentCameras. All arguments must outlive
  // the cost.
  ObservationCost(const Observation& observation, const Pose& start, const BundleCamera& measured,
                  const PresentCamera& now)
      : observation_(observation), start_(start), measured_(measured), now_(now) {}

  // Called by the solver. `jacobians` and each of its entries may be null. Returns true.
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  const Observation& observation_;
  const Pose& start_;
  const BundleCamera& measured_;
  const PresentCamera& now_;
};

}  // namespace axial::pose
