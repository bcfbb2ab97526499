// SPDX-License-Identifier: GPL-3.0-or-later
// Images and ground truth of a mesh seen by one camera, dry or through a port.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <opencv2/core.hpp>

#include "simulate/optics.h"
#include "simulate/ray_scene.h"

namespace axial::simulate {

// What a shader is told about the point it colours.
struct SurfacePoint {
  Eigen::Vector3d position;  // world
  Hit hit;
  double footprint = 0;  // width of one pixel there, across the ray [m]
};

// Linear colour (R G B, 0 to 1) of a surface point. Must not depend on the camera other than
// through the footprint. Called concurrently.
using Shader = std::function<Eigen::Vector3f(const SurfacePoint&)>;

// Linear image, channel order B G R, black where nothing is hit. Each pixel is the mean of
// `samples` x `samples` rays on a regular grid within it; rows are computed in parallel. Error
// unless 1 <= samples <= 16.
cv::Mat3f render_radiance(const RayScene& scene, const Shader& shader, const Lens& lens,
                          const Port* port, const View& view, int samples);

// Light scattered into the line of sight replaces the share `haze` (0 to 1) of what comes from the
// scene: all contrast shrinks to 1 - haze of what it was. The haze is grey (0.5).
void add_haze(cv::Mat3f& radiance, double haze);

// 8-bit image: 255 x radiance plus noise of standard deviation `noise` [grey levels], keyed by
// (key, pixel, channel); rounded and clamped.
cv::Mat3b develop(const cv::Mat3f& radiance, double noise, std::uint64_t key);

// The `key` under which a scene's images are developed.
std::uint64_t noise_key(std::uint32_t seed, std::size_t view, bool water);

// At the ray of each pixel's centre. `distance`: metres from the ray's meeting point with the
// camera's axis (C_v; dry: from the centre) to the surface, 0 where nothing is hit. `normal`: of
// the mesh face, world frame, components x y z; zero where nothing is hit.
struct Truth {
  cv::Mat1f distance;
  cv::Mat3f normal;
};
Truth render_truth(const RayScene& scene, const Lens& lens, const Port* port, const View& view);

}  // namespace axial::simulate
