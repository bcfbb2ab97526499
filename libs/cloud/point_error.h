// SPDX-License-Identifier: GPL-3.0-or-later
// Part of fuse(): the expected error of a point on which several depth maps agree.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "cloud/fusion_map.h"
#include "scene/camera_model.h"
#include "scene/pose.h"

namespace axial::cloud {

// The measurement of a point by one depth map. World frame.
struct PointSupport {
  Eigen::Vector3d point;  // back-projected point of the map's pixel [m]
  Eigen::Vector3d ray;    // unit vector from the camera to the point
  double pixel;           // width of the map's pixel at the point, with refraction [m]
  double depth;           // along the pixel's ray [m]
  double cost;            // of matching: 1 - the map's confidence; 1: unknown
};

// Makes the supports of one view in a tenth of the time that exact rays with derivatives need. It
// makes two approximations: the angular size of a pixel comes from a table (error 2 %), and rays
// start at the camera centre (error below a degree behind a port).
class SupportCamera {
 public:
  SupportCamera(const CameraModel& model, const Pose& pose);

  // The support of the map's pixel y * width + x. `depth` [m] must be above 0; `point` is the
  // pixel's back-projected point [world].
  PointSupport support(std::uint32_t pixel, double depth, double cost,
                       const Eigen::Vector3d& point) const;

 private:
  Eigen::Vector3d centre_;
  std::uint32_t width_, shift_ = 0, columns_;  // cells of 2^shift_ pixels
  std::vector<float> angles_;                  // angular size of a pixel in each cell [rad]
};

// Properties of a map and its photograph around one pixel.
struct Surroundings {
  // Mean of 1 - cosine of the angle between the pixel's normal and the normals of the pixels at a
  // distance of three. 0: flat, or the pixel's normal is unknown.
  double relief = 0;
  // Standard deviation of the position of a match due to noise in the photograph [px of the map].
  // It is large where there is little texture. 0: unknown.
  double noise = 0;
};
// Measures the surroundings of `pixel`. `reduction`: the width of the photograph divided by the
// width of the map. The noise is unknown for a map without colours.
Surroundings surroundings(const FusionMap& map, std::uint32_t pixel, double reduction);

// The standard deviation of a triangulated point along the unit vector `normal` [m per px]. The
// point is triangulated from the supports' pixels; both coordinates of each pixel have independent
// errors of 1 px. The result is at most the mean depth, also for parallel rays.
double triangulated_error(std::span<const PointSupport> supports, const Eigen::Vector3d& normal);

struct PointError {
  float error = 0;       // standard deviation of the distance to the true surface [m]; 0: unknown
  float confidence = 0;  // probability that the distance is at most 3 errors
};

// The expected error of the mean of the supports' points, on a surface with the unit normal
// `normal`. `around`: the surroundings of the point in the map of the first support. The variance
// is the sum of three parts:
//
// * relief: matching fits planes to windows of several pixels. Relief that planes cannot follow
//   raises the cost of even the best match and makes the normals of neighbouring pixels differ. All
//   maps are smoothed in the same way, so that more maps do not reduce this part, but wider angles
//   between the rays do;
// * the variance of the supports' points along the normal;
// * the photograph's noise, which matters where there is little texture.
//
// The confidence is higher if the supports' points are closer to each other. Both are 0 (unknown)
// for fewer than two supports and if no support has a known cost.
PointError expected_error(std::span<const PointSupport> supports, const Eigen::Vector3d& normal,
                          const Surroundings& around);

}  // namespace axial::cloud
