// SPDX-License-Identifier: GPL-3.0-or-later
// Inside of fuse(): what a point is worth that several depth maps agree on.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "cloud/fusion_map.h"
#include "scene/camera_model.h"
#include "scene/pose.h"

namespace axial::cloud {

// What one depth map says of a point, in the world's axes.
struct PointSupport {
  Eigen::Vector3d point;  // of the map's pixel [m]
  Eigen::Vector3d ray;    // from the camera to it, unit
  double pixel;           // width of the map's pixel at the point, through the port [m]
  double depth;           // along the pixel's ray [m]
  double cost;            // of matching: 1 - the map's confidence; 1: not known
};

// Makes the supports of one view. A pixel's angle is read off a table (to 2 %), and rays begin in
// the camera's centre (behind a port they are off by less than a degree): a tenth of the time that
// exact rays with derivatives take.
class SupportCamera {
 public:
  SupportCamera(const CameraModel& model, const Pose& pose);

  // Of pixel y * width + x, whose depth is above 0, and whose point is this one of the world.
  PointSupport support(std::uint32_t pixel, double depth, double cost,
                       const Eigen::Vector3d& point) const;

 private:
  Eigen::Vector3d centre_;
  std::uint32_t width_, shift_ = 0, columns_;  // cells of 2^shift_ pixels
  std::vector<float> angles_;                  // of a pixel in each cell [rad]
};

// What a map and its photograph show around one pixel.
struct Surroundings {
  double relief = 0;  // mean of 1 - cosine between its normal and those three pixels away; 0: none
  double noise = 0;   // standard deviation of a match's place for want of texture [px]; 0: unknown
};
// `reduction`: width of the photograph / of the map. The noise is unknown without colours.
Surroundings surroundings(const FusionMap& map, std::uint32_t pixel, double reduction);

// Standard deviation, along the unit vector `normal`, of the point that the supports' pixels
// triangulate if both coordinates of each have independent errors of 1 px [m per px]. Parallel rays
// give at most their depth.
double triangulated_error(std::span<const PointSupport> supports, const Eigen::Vector3d& normal);

struct PointError {
  float error = 0;       // standard deviation of the distance to the true surface [m]; 0: unknown
  float confidence = 0;  // probability that the distance is at most 3 errors
};

// Of the mean of the supports' points, on a surface with this unit normal, seen by the first
// support's map as `around` tells. The variance is a sum of three parts:
//
// * relief: matching fits planes to windows of some pixels. Relief that they cannot follow raises
//   the cost of even the best match, and the normals of neighbouring pixels differ. All maps are
//   smoothed alike, so that their number does not help, but wider angles between the rays do;
// * the variance of the supports' points along the normal;
// * the photograph's noise, where there is little texture.
//
// Confidence grows as the supports' points lie nearer to each other. Unknown with less than two
// supports, and where no cost is known.
PointError expected_error(std::span<const PointSupport> supports, const Eigen::Vector3d& normal,
                          const Surroundings& around);

}  // namespace axial::cloud
