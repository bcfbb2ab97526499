// SPDX-License-Identifier: GPL-3.0-or-later
// Renders photographs under water with the water's light: loss and scattering by wavelength, blur,
// the veil, and the camera's response.
#pragma once

#include <opencv2/core.hpp>
#include <span>
#include <string>
#include <variant>

#include "simulate/light.h"
#include "simulate/render.h"
#include "simulate/water.h"

namespace axial::simulate {

// Water with a spectrum and its light, or plain water, whose surfaces have the colours that their
// shader returns.
struct SpectralWater {
  Water water;
  Light light;
};
using AnyWater = std::variant<SpectralWater, PlainWater>;

// A scene for photographs with light. All objects must outlive it.
struct LitScene {
  const RayScene& scene;
  const TriangleMesh& mesh;                  // of the scene
  std::span<const Eigen::Vector3f> normals;  // vertex_normals() of the mesh
  const Shader& albedo;                      // returns reflectances
};

// A photograph of radiances, and the surface's colours in white light, each with the channel order
// B G R, linear. In units in which a white surface in the light of the water's surface is 1, before
// exposure. Albedo is 0 where a ray hits nothing. `lit`: the light of the surface as a share of
// that without shadows, 0 where a ray hits nothing; empty for plain water.
struct LitImage {
  cv::Mat3f radiance, albedo;
  cv::Mat1f lit;
};

// Renders the photograph of `view` through `port` (camera frame). Rays that hit nothing end after
// 50 m. Each pixel is the mean of `samples` x `samples` rays; the veil is that of the pixel's
// centre, up to the mean distance of its rays. Rows are computed in parallel. Throws an Error
// unless 1 <= samples <= 16.
LitImage render_underwater(const LitScene& scene, const AnyWater& water, const Lens& lens,
                           const Port& port, const View& view, int samples);

// The gain by which a white surface in daylight (or in the lamps' light) above water has equal
// channels, B G R. All 1 for plain water.
cv::Vec3f white_balance(const AnyWater& water);

// The factor of all photographs by which 98 % of the brightest channels of `images` are at most
// 0.8 after white_balance(). 1 if all are black.
double exposure(std::span<const cv::Mat3f> radiances, const cv::Vec3f& balance);

// How a camera maps light to the values of a photograph. `linear`: unchanged. `srgb`: the curve of
// sRGB (IEC 61966-2-1). `camera`: that curve with more contrast, as makers of cameras apply it.
enum class Response { linear, srgb, camera };
Response parse_response(const std::string& name);

// Applies exposure, balance and response to radiances; the result is within 0 to 1.
cv::Mat3f photograph_of(const cv::Mat3f& radiance, const cv::Vec3f& gains, Response response);

}  // namespace axial::simulate
