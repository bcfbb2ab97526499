// SPDX-License-Identifier: GPL-3.0-or-later
// The part of AdjustProblem that is about rigs.
#include <ceres/autodiff_cost_function.h>
#include <ceres/loss_function.h>

#include "base/error.h"
#include "pose/adjust/adjust_problem.h"
#include "pose/adjust/rig_residuals.h"
#include "pose/bundle/rig_fit.h"

namespace axial::pose {
namespace {

// The scale of Cauchy's loss of the deviation of a frame [standard deviations]. The length of six
// normal numbers is larger in 1 % of all cases. A photograph of another frame deviates by hundreds
// of standard deviations: with a loss that grows linearly, a few of them would change the scale.
constexpr double kRigLoss = 4.1;

void check_rig(const Rig& rig) {
  for (const RigCamera& camera : rig.cameras)
    if (!(camera.sigma_translation > 0) || !(camera.sigma_rotation > 0))
      fail(
          "bundle adjustment: the standard deviations of the camera {} in its rig are {} m and {} "
          "rad: both must be positive",
          camera.name, camera.sigma_translation, camera.sigma_rotation);
}

}  // namespace

std::size_t AdjustProblem::rig_camera_count() const {
  std::size_t count = 0;
  for (const Rig& rig : bundle_.rigs) count += rig.cameras.size();
  return count;
}

double* AdjustProblem::rig_block(std::size_t rig, std::size_t camera) {
  for (std::size_t i = 0; i < rig; ++i) camera += bundle_.rigs[i].cameras.size();
  return point_block(bundle_.points.size()) + kPoseNumbers * camera;
}

void AdjustProblem::fill_rigs() {
  for (std::size_t i = 0; i < bundle_.rigs.size(); ++i)
    for (std::size_t k = 0; k < bundle_.rigs[i].cameras.size(); ++k)
      std::ranges::copy(numbers_of(bundle_.rigs[i].cameras[k].now), rig_block(i, k));
}

void AdjustProblem::add_rigs() {
  for (std::size_t i = 0; i < bundle_.rigs.size(); ++i) {
    check_rig(bundle_.rigs[i]);
    add_frames(i);
    add_stated_poses(i);
  }
}

void AdjustProblem::add_frames(std::size_t index) {
  const Rig& rig = bundle_.rigs[index];
  const auto velocities = rig_velocities(bundle_, rig);
  using Cost = ceres::AutoDiffCostFunction<RigResidual, 6, kPoseNumbers, kPoseNumbers, kPoseNumbers,
                                           kPoseNumbers>;
  for (std::size_t i = 0; i < rig.frames.size(); ++i) {
    const RigFrame& frame = rig.frames[i];
    for (std::size_t k = 1; k < frame.images.size(); ++k) {
      const RigFrame::Image &a = frame.images[0], &b = frame.images[k];
      const RigCamera &one = rig.cameras[a.camera], &two = rig.cameras[b.camera];
      const Eigen::Vector3d moved =
          (two.delay - one.delay) * velocities[i].value_or(Eigen::Vector3d::Zero());
      problem_->AddResidualBlock(
          new Cost(new RigResidual{bundle_.images[a.image].pose, bundle_.images[b.image].pose,
                                   one.now, two.now, moved}),
          new ceres::CauchyLoss(kRigLoss), image_block(a.image), image_block(b.image),
          rig_block(index, a.camera), rig_block(index, b.camera));
    }
  }
}

void AdjustProblem::add_stated_poses(std::size_t index) {
  const Rig& rig = bundle_.rigs[index];
  for (std::size_t k = 0; k < rig.cameras.size(); ++k) {
    double* const block = rig_block(index, k);
    if (!problem_->HasParameterBlock(block)) continue;
    const RigCamera& camera = rig.cameras[k];
    if (camera.known == RigCamera::Known::fixed) problem_->SetParameterBlockConstant(block);
    if (camera.known == RigCamera::Known::stated)
      problem_->AddResidualBlock(
          new ceres::AutoDiffCostFunction<StatedRigResidual, 6, kPoseNumbers>(
              new StatedRigResidual{camera}),
          nullptr, block);
  }
}

void AdjustProblem::write_rigs(Bundle& bundle) {
  for (std::size_t i = 0; i < bundle.rigs.size(); ++i)
    for (std::size_t k = 0; k < bundle.rigs[i].cameras.size(); ++k) {
      PoseNumbers numbers;
      std::copy_n(rig_block(i, k), kPoseNumbers, numbers.begin());
      bundle.rigs[i].cameras[k].now = pose_with(bundle_.rigs[i].cameras[k].now, numbers);
    }
}

}  // namespace axial::pose
