// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/pose: a bundle as a Ceres problem.
#pragma once

#include <ceres/problem.h>

#include <memory>
#include <vector>

#include "pose/bundle/adjust_options.h"
#include "pose/bundle/observation_cost.h"

namespace axial::pose {

// The Ceres problem of a bundle. Its first residual blocks belong to the observations, in the order
// of the bundle. The blocks of the known distances, positions and places, of the measured numbers
// of cameras, of the excluded motions and of the rigs follow, in this order.
class AdjustProblem {
 public:
  // Both arguments must outlive this object. The constructor does not change the bundle. Throws
  // the errors of adjust() for invalid arguments.
  AdjustProblem(const Bundle& bundle, const AdjustOptions& options);

  // The problem. This object owns it.
  ceres::Problem& problem() { return *problem_; }

  // The parameter blocks that the solver changes. Constant blocks are left out. A block of a pose
  // has the numbers of PoseNumbers (observation_cost.h), a block of changes those of HousingChange,
  // and a block of a point the 3 coordinates of its position. The solver eliminates the blocks of
  // point_blocks(), so no residual may depend on two blocks of point_blocks(). Points with a known
  // distance to another point are therefore among camera_blocks(), and so are targets.
  std::vector<double*> camera_blocks();  // poses, also of cameras in rigs, changes of cameras,
                                         // these points
  std::vector<double*> point_blocks();   // all other points

  // The number of poses that the solver changes.
  std::size_t pose_count();

  // The index of the first image for which is_observed() is true; 0 if there is none. adjust() says
  // when its pose is constant.
  std::size_t anchor() const;
  // True if the pose of the image is in the problem: the image has an observation, a known
  // distance, position or place, or is in a frame of a rig.
  bool is_observed(std::size_t image) const {
    return problem_->HasParameterBlock(numbers_.data() + kPoseNumbers * image);
  }

  // The parameter block of the pose of an image, and of the changes of a camera. Both exist in the
  // problem only if a residual depends on them.
  double* image_block(std::size_t image) { return numbers_.data() + kPoseNumbers * image; }
  // Cameras that share their change (BundleCamera::same_as) have the same block.
  double* change_block(std::size_t camera) {
    const std::size_t owner = bundle_.cameras[camera].same_as.value_or(camera);
    return image_block(bundle_.images.size()) + kHousingNumbers * owner;
  }

  // The parameter block of the pose of a camera in its rig. It exists in the problem only if a
  // frame has a photograph of the camera and of another one.
  double* rig_block(std::size_t rig, std::size_t camera);

  // Writes the present values of the parameter blocks, as poses, points and changes, to `bundle`,
  // which is the bundle of the constructor or a copy of it.
  void write_back(Bundle& bundle);

  // The block of the position of a point.
  double* point_block(std::size_t point) {
    return image_block(bundle_.images.size()) + kHousingNumbers * bundle_.cameras.size() +
           3 * point;
  }

 private:
  // False if the camera shares the change of another camera.
  bool owns_change(std::size_t camera) const { return !bundle_.cameras[camera].same_as; }
  void fill_numbers();
  void add_observations();
  void add_known();
  void add_known_positions();
  void add_known_place(const KnownPlace& known, ceres::LossFunction* loss);
  void exclude_free_motions();
  void add_known_distance(const KnownDistance& known);
  void add_measured(std::size_t camera, int number);
  std::size_t rig_camera_count() const;
  void fill_rigs();
  void add_rigs();
  void add_frames(std::size_t rig);
  void add_stated_poses(std::size_t rig);
  void write_rigs(Bundle& bundle);
  void fix_points();
  void fix_poses();
  void fix_what_stays();

  const Bundle& bundle_;
  const AdjustOptions& options_;
  // All parameter blocks: of the poses, of the changes, of the points and of the rigs. The solver
  // orders blocks by their addresses: in one array, the order is the same in every run.
  std::vector<double> numbers_;
  std::vector<bool> tied_;  // points with a known distance to another point, and targets
  std::unique_ptr<CurrentCameras> cameras_;
  std::unique_ptr<ceres::Problem> problem_;
};

}  // namespace axial::pose
