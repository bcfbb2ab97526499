// SPDX-License-Identifier: GPL-3.0-or-later
// Inside of fuse(): what a point is worth that several depth maps agree on.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>

#include "scene/any_camera.h"
#include "scene/pose.h"

namespace axial::cloud {

// What one depth map says of a point, in the world's axes.
struct PointSupport {
  Eigen::Vector3d point;                 // of the map's pixel [m]
  Eigen::Vector3d ray;                   // of that pixel, unit
  Eigen::Matrix<double, 2, 3> jacobian;  // d(pixel)/d(point) there [px/m], through the port
  double depth;                          // along the pixel's ray [m]
  double cost;                           // of matching: 1 - the map's confidence; 1: not known
};

// Makes the supports of one view.
class SupportCamera {
 public:
  SupportCamera(const CameraModel& model, const Pose& pose);

  // Of pixel y * width + x, whose depth is above 0, and whose point is this one of the world.
  PointSupport support(std::uint32_t pixel, double depth, double cost,
                       const Eigen::Vector3d& point) const;

 private:
  AnyCamera<double> camera_;
  Pose pose_;
  std::uint32_t width_;
};

// Standard deviation, along the unit vector `normal`, of the point that the supports' pixels
// triangulate if both coordinates of each have independent errors of 1 px [m per px]. Parallel rays
// give at most their depth.
double triangulated_error(std::span<const PointSupport> supports, const Eigen::Vector3d& normal);

struct PointError {
  float error = 0;       // standard deviation of the distance to the true surface [m]; 0: unknown
  float confidence = 0;  // probability that the distance is at most 3 errors
};

// Of the mean of the supports' points, on a surface with this unit normal: triangulated_error(),
// times the noise of the best match among them, which grows where the surface is seen at a slant,
// times the number of supports. For maps that agree were matched on the same photographs, and what
// smooths a surface is the same in all: another one helps as far as it widens the angle between the
// rays or matches better, not by its number. Confidence grows as the supports' points lie nearer to
// each other than the error. Unknown with less than two supports, and where no cost is known. The
// constants were fitted to maps of this project's matching.
PointError expected_error(std::span<const PointSupport> supports, const Eigen::Vector3d& normal);

}  // namespace axial::cloud
