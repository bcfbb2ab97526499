// SPDX-License-Identifier: GPL-3.0-or-later
// Resamples photographs and depth maps of any camera to a pinhole (PinholeView). A pixel of the
// pinhole sees a point of the surface; it gets the value of the camera at the image of this point.
// The result is exact where the depth map has a surface.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

#include "cloud/pinhole_view.h"
#include "scene/depth_map.h"

namespace axial::cloud {

// Renders the surface of `map` into the pinhole. For each pixel of the pinhole, the result is
// 1 / z-depth [1/m] of the nearest surface, or 0 without a surface. Neighbouring pixels of `map`
// form triangles. A triangle is left out if it bridges a step in depth: its depths differ by more
// than 1 %, and the angle between surface and ray is below 6 degrees. `view` stands for the map's
// camera, at any resolution. Throws an Error if the map and its camera differ in size.
cv::Mat1f render_surface(const DepthMap& map, const PinholeView& view);

// `inverse_depth` with its zeros filled by smooth interpolation of the surrounding values. If all
// values are zero, the result is `otherwise` everywhere.
cv::Mat1f filled(const cv::Mat1f& inverse_depth, float otherwise);

// The pixels at which `camera` images the points that the rows [rows.start, rows.end) of the
// pinhole see. `inverse_depth`: 1 / z-depth [1/m] of these rows only; 0: no point. The result is
// (-10, -10) where there is no point or where the camera does not see it.
cv::Mat2f seen_by(const CameraModel& camera, const PinholeView& view,
                  const cv::Mat1f& inverse_depth, cv::Range rows);

// Values of PinholeImage::label. kNothing: the pixel is black, because it has no pixel of the
// photograph or only a transparent one.
inline constexpr std::uint8_t kNothing = 0;
inline constexpr std::uint8_t kGuess = 128;  // the depth is interpolated between surfaces
inline constexpr std::uint8_t kExact = 255;  // the depth is that of a surface

struct PinholeImage {
  cv::Mat3b color;
  cv::Mat1b label;
};

// The photograph (B G R) as the pinhole's image, of the size of `view.camera`. `opaque`: empty, or
// 0 where the photograph is transparent. `camera`: the photograph's camera at its resolution.
// `surface`: the result of render_surface(map, view). `guess`: inverse depths [1/m] for pixels
// without a surface, of any resolution, made by filled(). Throws an Error if sizes disagree.
PinholeImage resampled(const cv::Mat3b& photograph, const cv::Mat1b& opaque,
                       const CameraModel& camera, const PinholeView& view, const cv::Mat1f& surface,
                       const cv::Mat1f& guess);

// The depth map as that of the pinhole, of the size of `view.camera`. The depths are those of
// `surface`, the result of render_surface(map, view). Normals and confidences are those of the
// nearest pixel of `map`; a normal that faces away from the pinhole becomes 0. The ids and the
// image path are kept. Throws an Error if `surface` and the pinhole's camera differ in size.
DepthMap resampled(const DepthMap& map, const PinholeView& view, const cv::Mat1f& surface);

}  // namespace axial::cloud
