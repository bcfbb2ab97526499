// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/pose: where the true centre of a target is imaged, by the shape of the target.
#pragma once

#include <span>
#include <vector>

#include "pose/bundle/bundle.h"
#include "pose/bundle/target.h"
#include "refractive/axial_ray.h"

namespace axial::pose {

// A circle in the world [m].
struct Circle {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // of its plane, unit
  double radius = 0;
};

// The circle about `centre` that has the smallest squared distances to the rays of its outline in
// its plane. `outlines`: the rays of each photograph [world]; one or more photographs with three or
// more rays each. Distances count in units of the radius, and large ones count linearly.
Circle circle_about(const Eigen::Vector3d& centre,
                    std::span<const std::vector<refractive::AxialRay<double>>> outlines);

// The centre of the ellipse through the image of the circle's outline [px]. Not finite if a part
// of the outline has no image.
Eigen::Vector2d centre_of_image(const Circle& circle, const PhotographCamera& camera,
                                const Pose& pose);

// For each image of the target, the pixel of the true centre minus the measured feature
// (TargetImage::pixel without errors) [px]. Zero where the shape does not determine it: for targets
// without shape, for squares with corners in fewer than two images, and where a part of the target
// has no image. `place`: of the target [m]. `cameras`: cameras_now(bundle).
std::vector<Eigen::Vector2d> centre_corrections(const Bundle& bundle,
                                                std::span<const PhotographCamera> cameras,
                                                const Target& target, const Eigen::Vector3d& place);

// The point where the diagonals of a quadrilateral meet. Not finite if they are parallel.
Eigen::Vector2d diagonals_meet(const std::array<Eigen::Vector2d, 4>& corners);

}  // namespace axial::pose
