// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "map/pixel_width.h"
#include "scene/any_camera.h"

namespace axial::map {

// The default of `noise` below [px]. A surface is measured by many matches, which share their
// pixels, so that its noise is far below that of a single match.
inline constexpr double kDefaultNoise = 0.05;

// The expected errors of the heights of a map: one standard deviation. A displacement e of a
// surface with the unit normal n changes its height above a fixed place of the map by
// (n . e) / (n . up). The expected error is the standard deviation of this change. The variance
// along n is the sum of two parts:
//
// * Intersection of the paths of light. A photograph measures the two coordinates of a place in its
//   image with independent errors of the standard deviation `noise` [px]. The place gets the
//   covariance that these measurements give by least squares, with the derivatives of the exact
//   camera, so that refraction is included.
// * Resolution: kResolution times the width of a photograph's pixel at the place, in the photograph
//   with the narrowest pixels. Matching and meshing smooth the surface over some pixels.
//
// Not included are errors of poses, cameras and scale, wrong matches, edges at depth steps that are
// displaced, and the texture and the relief of the place.
class HeightErrors {
 public:
  // A rounded fit to simulated scenes (docs/maps.md).
  static constexpr double kResolution = 0.33;
  // The smallest n . up that is used.
  static constexpr double kLeastCosine = 0.1;

  // `up`: unit vector of the heights in the frame of the photographs' poses. `noise`: above 0 [px].
  HeightErrors(std::span<const PosedCamera> photos, const Eigen::Vector3d& up, double noise);

  // The expected error [m] of the height of the place `point` [frame of the poses] on a surface
  // with the normal `normal`, of any length. `views`: the photographs that see the place, as
  // indices. kNoHeight (geotiff.h) for fewer than two photographs. May be called concurrently.
  float at(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
           std::span<const std::uint32_t> views) const;

 private:
  std::vector<AnyCamera<double>> cameras_;
  std::vector<Pose> poses_;
  Eigen::Vector3d up_;
  double noise_;
};

}  // namespace axial::map
