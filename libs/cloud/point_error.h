// SPDX-License-Identifier: GPL-3.0-or-later
// Part of fuse(): the expected error of a point on which several depth maps agree.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "axial/scene.h"
#include "cloud/fusion_map.h"
#include "scene/camera_model.h"

namespace axial::cloud {

// The measurement of a point by one depth map, in the world frame.
struct PointSupport {
  Eigen::Vector3d point;  // back-projected point of the map's pixel [m]
  Eigen::Vector3d ray;    // unit vector from the camera to the point
  double pixel;           // width of a pixel of the map at the point, with refraction [m]
  double depth;           // along the pixel's ray [m]
  double cost;            // matching cost: 1 - the map's confidence; 1: unknown
};

// Makes the supports of one view. Two approximations save nine tenths of the time of exact rays
// with derivatives. The angular size of a pixel comes from a table (error 2 %). Rays start at the
// camera centre (error of their direction behind a port: below one degree).
class SupportCamera {
 public:
  // `model`: the camera of a depth map at the map's resolution. `pose`: its pose.
  SupportCamera(const CameraModel& model, const Pose& pose);

  // The support of the pixel with the number `pixel`, y * width + x. `depth`: of the pixel along
  // its ray [m], above 0. `cost`: PointSupport::cost. `point`: the back-projected point of the
  // pixel [m], in the world frame.
  PointSupport support(std::uint32_t pixel, double depth, double cost,
                       const Eigen::Vector3d& point) const;

 private:
  Eigen::Vector3d centre_;
  std::uint32_t width_, shift_ = 0, columns_;  // the table's cells are 2^shift_ x 2^shift_ pixels
  std::vector<float> angles_;                  // angular size of a pixel in each cell [rad]
};

// Properties of a map and its photograph around one pixel.
struct Surroundings {
  // Let c be the cosine of the angle between the normal of the pixel and the normal of another
  // pixel. The relief is the mean of 1 - c (no unit) over eight pixels: those 3 px away in x, in y,
  // or in both. Pixels outside the map or without a normal are left out. 0: flat, or the normal of
  // the pixel is unknown.
  double relief = 0;
  // Standard deviation of the position of a match due to noise in the photograph [px of the map].
  // The deviation is large where there is little texture. 0: unknown.
  double noise = 0;
};
// Measures the surroundings of the pixel with the number `pixel`, y * width + x. `reduction`: the
// width of the photograph divided by the width of the map. The noise is unknown for a map without
// colours.
Surroundings surroundings(const FusionMap& map, std::uint32_t pixel, double reduction);

// The standard deviation [m], along the unit vector `normal` (world frame), of the point that is
// triangulated from the supports. Each support contributes one pixel to the triangulation. The two
// coordinates of each pixel have independent errors with a standard deviation of 1 px. The result
// is never larger than the mean depth [m] of the supports, even for parallel rays. Precondition:
// there is at least one support.
double triangulated_error(std::span<const PointSupport> supports, const Eigen::Vector3d& normal);

// The result of expected_error().
struct PointError {
  float error = 0;       // standard deviation of the distance to the true surface [m]; 0: unknown
  float confidence = 0;  // probability that the distance is at most 3 errors; 0: unknown
};

// The expected error of a point that is the mean of the supports' points, on a surface with the
// unit normal `normal` (world frame). `around`: the surroundings of the point in the map of the
// first support. The variance is the sum of three parts:
//
// * Relief: matching fits planes to windows of several pixels. Relief that planes cannot follow
//   raises the cost of even the best match and makes the normals of neighbouring pixels differ.
//   More maps do not reduce this part, because all maps are smoothed in the same way. Wider angles
//   between the rays reduce it.
// * Scatter: the variance of the supports' points along the normal.
// * Noise of the photograph, which is large where there is little texture.
//
// The confidence is higher if the supports' points are closer to each other. Error and confidence
// are 0 (unknown) if there are fewer than two supports, or if no support has a known cost.
PointError expected_error(std::span<const PointSupport> supports, const Eigen::Vector3d& normal,
                          const Surroundings& around);

}  // namespace axial::cloud
