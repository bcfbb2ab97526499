// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/pose: a bundle as a Ceres problem.
#pragma once

#include <ceres/problem.h>

#include <memory>
#include <vector>

#include "pose/adjust.h"
#include "pose/observation_cost.h"

namespace axial::pose {

// Residual blocks: first all observations, in their order, then what is known besides.
class AdjustProblem {
 public:
  // `bundle` must outlive this; it is not changed before write_back().
  AdjustProblem(const Bundle& bundle, const AdjustOptions& options);

  ceres::Problem& problem() { return *problem_; }

  // Blocks under adjustment, those that stay left out. Points have 3 numbers each.
  std::vector<double*> camera_blocks();  // images, changes of cameras, points of known lengths
  std::vector<double*> point_blocks();   // all other points, which are independent of each other

  // The first image that is observed in: it stays where it is.
  std::size_t anchor() const;
  bool is_observed(std::size_t image) const {
    return problem_->HasParameterBlock(poses_[image].data());
  }

  double* image_block(std::size_t image) { return poses_[image].data(); }
  double* change_block(std::size_t camera) { return changes_[camera].data(); }

  void write_back(Bundle& bundle) const;

 private:
  void add_observations();
  void add_known();
  void add_known_distance(const KnownDistance& known);
  void fix_points();
  void fix_poses();
  void fix_what_stays();

  const Bundle& bundle_;
  const AdjustOptions& options_;
  std::vector<PoseNumbers> poses_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<bool> tied_;  // points that a known length ties to another
  std::vector<HousingChange<double>> changes_;
  std::unique_ptr<CurrentCameras> cameras_;
  std::unique_ptr<ceres::Problem> problem_;
};

}  // namespace axial::pose
