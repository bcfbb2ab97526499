// SPDX-License-Identifier: GPL-3.0-or-later
// Resamples photographs and depth maps of any camera to a pinhole (PinholeView). A pixel of the
// pinhole sees a point X of the surface. The pixel gets the value of the camera's image at the
// projection of X into the camera. The result is exact where the depth map has a surface.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

#include "cloud/pinhole_view.h"
#include "scene/depth_map.h"

namespace axial::cloud {

// Renders the surface of `map` into the pinhole. The result has one value for each pixel of the
// pinhole: 1 / z-depth [1/m] of the nearest surface, or 0 without a surface. Neighbouring pixels of
// `map` form triangles. A triangle is left out if it bridges a step in depth, which means that its
// depths differ by more than 1 % and the angle between its plane and the ray is below 6 degrees.
// `view`: the pinhole that replaces the map's camera, at any resolution. Throws an Error if the map
// and its camera differ in size.
cv::Mat1f render_surface(const DepthMap& map, const PinholeView& view);

// Returns `inverse_depth` with interpolated values in place of its zeros. The interpolation is
// smooth and uses the surrounding values. If all values are zero, the result is `otherwise`
// everywhere.
cv::Mat1f filled(const cv::Mat1f& inverse_depth, float otherwise);

// Projects the points that the pinhole sees into `camera`. Returns the pixels of `camera` for the
// rows [rows.start, rows.end) of the pinhole. `inverse_depth`: 1 / z-depth [1/m] of the points of
// these rows only; 0: no point. The result is (-10, -10) where there is no point or where `camera`
// does not see the point.
cv::Mat2f seen_by(const CameraModel& camera, const PinholeView& view,
                  const cv::Mat1f& inverse_depth, cv::Range rows);

// Values of PinholeImage::label: how the colour of a pixel was found. kNothing: the pixel is black,
// because the photograph has no pixel there, or because its pixel is transparent.
inline constexpr std::uint8_t kNothing = 0;
inline constexpr std::uint8_t kGuess = 128;  // the depth is interpolated between surfaces
inline constexpr std::uint8_t kExact = 255;  // the depth is that of a surface

struct PinholeImage {
  cv::Mat3b color;
  cv::Mat1b label;
};

// Resamples a photograph (B G R) to the pinhole. The result has the size of `view.camera`.
// `opaque`: empty, or 0 where the photograph is transparent. `camera`: the photograph's camera at
// the photograph's resolution. `surface`: the result of render_surface(map, view) for the
// photograph's depth map. `guess`: the result of filled(), at any resolution. Pixels without a
// surface use its inverse depths [1/m]. Throws an Error if sizes disagree or if `guess` is empty.
PinholeImage resampled(const cv::Mat3b& photograph, const cv::Mat1b& opaque,
                       const CameraModel& camera, const PinholeView& view, const cv::Mat1f& surface,
                       const cv::Mat1f& guess);

// Resamples a depth map to the pinhole. The result has the size of `view.camera`. `surface`: the
// result of render_surface(map, view), from which the depths are taken. Normals and confidences are
// taken from the nearest pixel of `map`. A normal that faces away from the pinhole becomes 0. The
// ids and the image path are kept. Throws an Error if `surface` and the pinhole's camera differ in
// size.
DepthMap resampled(const DepthMap& map, const PinholeView& view, const cv::Mat1f& surface);

}  // namespace axial::cloud
