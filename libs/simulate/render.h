// SPDX-License-Identifier: GPL-3.0-or-later
// Renders images and ground truth of a mesh seen by one camera, dry or through a port.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <opencv2/core.hpp>
#include <optional>

#include "simulate/optics.h"
#include "simulate/ray_scene.h"

namespace axial::simulate {

// The argument of a shader: a point on the surface.
struct SurfacePoint {
  Eigen::Vector3d position;  // world
  Hit hit;
  double footprint = 0;  // width of a pixel at the point, across the ray [m]
};

// Returns the linear colour (R G B, 0 to 1) of a surface point. The colour may depend on the camera
// only through SurfacePoint::footprint. Shaders are called concurrently.
using Shader = std::function<Eigen::Vector3f(const SurfacePoint&)>;

// Returns where the ray of pixel (u, v) first meets the scene; empty if the pixel has no ray or the
// ray hits nothing. `port`: the port in the camera frame of `view`; null for a dry camera.
std::optional<SurfacePoint> surface_point(const RayScene& scene, const Lens& lens, const Port* port,
                                          const View& view, double u, double v);

// Renders a linear image with the channel order B G R. Rays that hit nothing, and pixels without a
// ray (trace_pixel()), are black. `port`: the port in the camera frame of `view`; null for a dry
// camera. Each pixel is the mean of `samples` x `samples` rays on a regular grid in the pixel. Rows
// are computed in parallel. Throws an Error unless 1 <= samples <= 16.
cv::Mat3f render_radiance(const RayScene& scene, const Shader& shader, const Lens& lens,
                          const Port* port, const View& view, int samples);

// Adds haze: replaces a share `haze` (0 to 1) of the light from the scene by grey light (0.5)
// that is scattered into the line of sight. All contrast is multiplied by 1 - haze.
void add_haze(cv::Mat3f& radiance, double haze);

// Returns the 8-bit image (B G R): 255 x radiance plus noise of standard deviation `noise` [grey
// levels], clamped to 0 to 255 and rounded. The noise depends on (key, pixel, channel) only.
cv::Mat3b develop(const cv::Mat3f& radiance, double noise, std::uint64_t key);

// Returns the `key` of develop() for an image. `seed`: of the scene. `view`: index of the image's
// view, below 2^31. `water`: the image is taken under water. Images that differ in any of the three
// have different keys.
std::uint64_t noise_key(std::uint32_t seed, std::size_t view, bool water);

// Ground truth for the ray of each pixel's centre. `distance`: the distance [m] along the ray to
// the surface, from the point where the ray's line meets the camera's axis (SceneRay::on_axis).
// `normal`: the unit normal of the mesh face, in the world frame (x, y, z). Both are 0 where the
// pixel has no ray or the ray hits nothing.
struct Truth {
  cv::Mat1f distance;
  cv::Mat3f normal;
};
// The ground truth of `view`. `port`: the port in the camera frame of `view`; null for a dry
// camera.
Truth render_truth(const RayScene& scene, const Lens& lens, const Port* port, const View& view);

}  // namespace axial::simulate
